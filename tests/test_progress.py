"""Progress is a bar in place on a terminal, within its width, and few plain lines in a log."""

import fcntl
import io
import os
import pty
import select
import struct
import termios
from types import SimpleNamespace

import pytest

from fecolumn.foundation.progress import Bar, CountProgress, Progress, clock


@pytest.fixture
def terminal():
    """A terminal of 60 columns, and what reads it."""
    reader, writer = pty.openpty()
    fcntl.ioctl(writer, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 60, 0, 0))
    stream = open(writer, "w")

    def read() -> str:
        text = b""
        # a terminal hands on what it gets some time later
        while select.select([reader], [], [], 0.5)[0]:
            text += os.read(reader, 1_000_000)
        return text.decode()

    yield stream, read
    stream.close()
    os.close(reader)


def test_bar_is_drawn_in_place_within_the_width_of_the_terminal(terminal, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal[0])
    progress = Progress(200, 0.01)
    for step in (1, 50, 100):
        progress._shown = -1.0  # as if a second had gone by
        progress.show(
            step,
            dict(time=0.01 * step, tilt=0.1, active_nodes=7),
            SimpleNamespace(iterations=3 * step),
        )
    progress.end()
    text = terminal[1]()
    lines = text.replace("\r\n", "\n").split("\r")
    assert " 25 %|" in text and " 50 %|" in text and "t   1.0000 of 2.00 s  left 0 s" in text
    assert (
        text.count("\n") == 1
        and text.endswith("\n")
        and max(len(line.strip()) for line in lines) <= 60
    )


def test_counted_things_leave_nothing_on_the_terminal(terminal, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal[0])
    progress = CountProgress(4, "pictures")
    progress._shown = -1.0
    progress.show(2)
    progress.end()
    text = terminal[1]()
    assert (
        " 50 %|" in text
        and "2 of 4 pictures, left 0 s" in text
        and "\n" not in text
        and text.endswith("\r")
    )


def test_a_terminal_that_does_not_know_its_width_gets_the_whole_line(terminal, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal[0])
    fcntl.ioctl(terminal[0].fileno(), termios.TIOCSWINSZ, bytes(8))
    bar = Bar(4)
    bar.draw(1, words := "word " * 40 + "end")
    bar.end()
    assert words in terminal[1]()


@pytest.mark.parametrize("total", [0, 10])
def test_a_bar_of_nothing_is_drawn_too(terminal, total):
    bar = Bar(total, stream=terminal[0])
    bar.draw(total, "nothing to do")
    bar.end()
    assert "nothing to do" in terminal[1]()


def test_log_gets_plain_lines_and_a_quiet_analysis_none(monkeypatch):
    for quiet, lines in ((False, 1), (True, 0)):
        monkeypatch.setattr("sys.stderr", stream := io.StringIO())
        progress = CountProgress(4, "pictures", quiet)
        progress.show(1)  # too soon
        progress._shown = -11.0
        progress.show(2)
        progress.show(3)  # too soon again
        progress.end()
        assert (
            stream.getvalue().count("2 of 4 pictures, left")
            == stream.getvalue().count("\n")
            == lines
            and "\r" not in stream.getvalue()
        )


def test_a_log_on_a_full_disk_ends_nothing():
    full = open("/dev/full", "w")
    bar = Bar(2, stream=full)
    bar.draw(1, "half")
    bar.end()
    with pytest.raises(OSError, match="No space left"):  # what the log could not take
        full.close()


@pytest.mark.parametrize("seconds, text", [(3.2, "3 s"), (303, "5 min 03 s"), (3900, "1 h 05 min")])
def test_times_are_told_in_words(seconds, text):
    assert clock(seconds) == text
