"""Failed analyses of fecolumn design and screen are tried again where that is asked for; options
that commands share.
"""

import json
import sqlite3

import pytest

import fecolumn.study.run
from fecolumn.cli import _parser, main
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.study.questions.given import FEWEST_MOTIONS

LIST = "name,width_m,depth_m,height_m,mass_kg,friction\na,0.3,0.3,2,30,0.9\nb,0.6,0.3,2,60,0.9\n"


@pytest.fixture(scope="module")
def asked(tmp_path_factory):
    """A folder with a block, a list and six pulses; commands that end in a folder OUT."""
    folder = tmp_path_factory.mktemp("retry")
    words = ["one_sine", "--amplitudes", *"123456", "--periods", "0.5", "-o", str(folder / "p.h5")]
    assert main(["motions", "make", "pulses", *words]) == 0
    (folder / "block.toml").write_text("[block]\nwidth_m = 0.3\nheight_m = 2.0\n")
    (folder / "list.csv").write_text(LIST)
    motions = ["-j", "1", "--motions", f"{folder / 'p.h5'}#*"]
    vary = ["--vary", "block.width_m", "0.2:0.6", "--steps", "4"]
    return {
        "design": [str(folder / "block.toml"), *vary, "--limit", "P(overturn) < 0.5", *motions],
        "screen": [str(folder / "list.csv"), "--engine", "housner", *motions],
    }


def fail(folder, count):
    """Have the first analyses that are done failed, as if they had."""
    with sqlite3.connect(folder / "study.sqlite") as ledger:
        rows = ledger.execute("SELECT id FROM analysis WHERE state = 'done' ORDER BY place")
        for (case_id,) in rows.fetchall()[:count]:
            (folder / "analyses" / case_id / "summary.json").unlink()
            ledger.execute(
                "UPDATE analysis SET state = 'failed', reason = 'broken', summary = NULL "
                "WHERE id = ?",
                (case_id,),
            )


def watch(monkeypatch):
    """The looks of a command from now on: the ids each runs again where they failed, and its
    stream of progress.
    """
    looks, whole = [], fecolumn.study.run.complete_study

    def watched(plan, *args, **options):
        again, only = options["retry_failed"], options["only"]
        every = {one.id for one in plan.analyses} if only is None else only
        ids = (every if again is True else every & again) if again else set()
        looks.append((ids, options["stream"]))
        return whole(plan, *args, **options)

    monkeypatch.setattr(fecolumn.study.run, "complete_study", watched)
    return looks


@pytest.mark.long
@pytest.mark.parametrize("command", ["design", "screen"])
def test_what_failed_is_told_and_tried_again(asked, tmp_path, capsys, command):
    words = [command, *asked[command], "-o", str(tmp_path / "out")]
    assert main(words) == 0
    fail(tmp_path / "out", 2)
    capsys.readouterr()
    assert main([*words, "-q"]) == 1
    said = capsys.readouterr().err.splitlines()
    told = [line for line in said if not line.startswith("fecolumn: warning:")]
    assert len(told) == 3 and told[0].startswith("failed: ") and told[0].endswith(": broken")
    assert told[-1] == "2 failed: add --retry-failed to run what failed again"
    assert main([*words, "--retry-failed"]) == 0
    assert "failed: " not in capsys.readouterr().err


@pytest.mark.long
def test_design_tries_once_in_all_its_looks(asked, tmp_path, monkeypatch):
    words = ["design", *asked["design"], "-o", str(tmp_path / "out"), "--retry-failed"]
    looks = watch(monkeypatch)
    assert main(words) == 0
    again = [one for ids, _ in looks for one in ids]
    assert len(looks) > 1 and len(again) == len(set(again)) == 30


@pytest.mark.long
def test_value_at_which_all_failed_is_told_with_the_way_out(asked, tmp_path, capsys):
    words = ["design", *asked["design"], "-o", str(tmp_path / "out")]
    assert main(words) == 0
    fail(tmp_path / "out", 6)
    capsys.readouterr()
    assert main([*words, "-q"]) == 1
    assert capsys.readouterr().err == (
        "fecolumn design: block.width_m = 0.2: no analysis is done, broken: add --retry-failed to "
        "run what failed again\n"
    )
    assert main([*words, "--retry-failed", "-q"]) == 0


@pytest.mark.long
@pytest.mark.parametrize("command", ["design", "screen"])
def test_quiet_command_tells_no_progress(asked, tmp_path, capsys, command):
    words = [command, *asked[command], "-o", str(tmp_path / "out")]
    assert main([*words, "-q"]) == 0
    told = capsys.readouterr()
    assert told.out and all(line.startswith("fecolumn: warning:") for line in told.err.splitlines())
    assert main(words) == 0
    assert " analyses, " in capsys.readouterr().err


@pytest.mark.long
def test_event_of_a_screening_may_be_given_by_its_older_name(asked, tmp_path, capsys):
    warn_of_older_name.cache_clear()
    words = ["screen", *asked["screen"], "-o", str(tmp_path / "out")]
    assert main([*words, "--event", "top > 5 mm", "--limit", "overturn", "-q"]) == 0
    told = capsys.readouterr()
    assert "fecolumn screen: --limit is an older name of --event, read until 2.0" in told.err
    assert "top > 5 mm" in told.out and "overturn" in told.out
    risk = _parser().parse_args("risk runs.csv --hazard h.csv -o out --limit lost".split())
    assert risk.event == "lost"


def test_help_tells_the_events_and_the_fewest_motions(capsys):
    with pytest.raises(SystemExit):
        main(["screen", "--help"])
    told = " ".join(capsys.readouterr().out.split())
    assert f"for every variant or object, {FEWEST_MOTIONS} or more" in told
    assert "overturn and slide > 10 mm, with --engine housner overturn and top > 10 mm" in told
    assert "--limit" not in told


@pytest.mark.long
def test_stages_of_a_study_try_once_what_failed(tmp_path, monkeypatch, capsys):
    (tmp_path / "study.toml").write_text(
        "[case.block]\nwidth_m = 0.3\nheight_m = 2.0\n[case.integration]\ndt_s = 0.01\n"
        '[axes]\n"block.restitution" = [0.9, 0.9001]\n"motion.source" = ["lick:1-80"]\n'
    )
    looks = watch(monkeypatch)
    words = ["study", str(tmp_path / "study.toml"), "-o", str(tmp_path / "out"), "-j", "1", "-q"]
    more = ["--until", "decided", "--retry-failed"]
    assert main([*words, *more]) == 0
    again = [one for ids, _ in looks for one in ids]
    assert len(looks) > 1 and len(again) == len(set(again)) > 0
    assert {stream for _, stream in looks} == {None}
    told = capsys.readouterr()
    assert (
        "analyses," not in told.err
        and "motions: " not in told.err
        and json.loads((tmp_path / "out" / "study.json").read_text())
    )
