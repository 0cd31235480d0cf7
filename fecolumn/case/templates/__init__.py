"""`fecolumn new`: a commented case and a study of it to start from."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).parent
#: What each kind is, by its name.
KINDS = {
    "tube": "steel tube with a cap plate",
    "solid": "marble cylinder",
    "block": "marble block",
    "mesh": "mesh of your own (an Abaqus .inp is given)",
    "arch": "stone arch of eleven voussoirs",
}

# Files of a kind and their templates, where they are other than those of the first ones
_OTHERS = {"mesh": {"column.inp": "column.inp"}, "arch": {"study.toml": "arch_study.toml"}}


def add_arguments(parser) -> None:
    """Arguments of `fecolumn new`."""
    kinds = "; ".join(f"{name}: {what}" for name, what in KINDS.items())
    parser.add_argument(
        "kind",
        nargs="?",
        default="tube",
        choices=tuple(KINDS),
        metavar="KIND",
        help=f"{kinds} (default: %(default)s)",
    )
    parser.add_argument(
        "folder",
        metavar="DIR",
        help="folder for case.toml and study.toml, made if missing; nothing there is overwritten",
    )


def main(args) -> int:
    """Write the files; returns 0.

    Raises
    ------
    InputError
        one of the files is there already, or the folder cannot be written.
    """
    for file in write(args.kind, args.folder):
        print(f"wrote {file}")
    print(f"next: fecolumn mesh {Path(args.folder) / 'case.toml'} -o {Path(args.folder) / 'mesh'}")
    print(f"      fecolumn run {Path(args.folder) / 'case.toml'} -o {Path(args.folder) / 'run'}")
    print(
        f"      fecolumn study {Path(args.folder) / 'study.toml'} -o {Path(args.folder) / 'study'}"
    )
    return 0


def write(kind: str, folder) -> list[Path]:
    """Write the files of a kind into a folder; as of `main`."""
    from fecolumn.foundation.schema import InputError

    folder = Path(folder)
    contents = {"case.toml": f"{kind}.toml", "study.toml": "study.toml"} | _OTHERS.get(kind, {})
    for name in contents:
        if (folder / name).exists() or (folder / name).is_symlink():
            raise InputError(
                "fecolumn new",
                "DIR",
                str(folder),
                f"has a {name} already, which is not overwritten; give a new folder",
            )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, template in contents.items():
            with open(folder / name, "x", encoding="utf-8") as file:
                file.write((_FOLDER / template).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(
            "fecolumn new", "DIR", str(folder), f"cannot be written ({error.strerror})"
        ) from None
    return [folder / name for name in contents]
