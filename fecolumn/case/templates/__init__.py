"""`fecolumn new`: a commented case and a study of it to start from."""

from __future__ import annotations

import argparse
from pathlib import Path

from fecolumn.mesh.mesh_file import METRES, MeshFile

_FOLDER = Path(__file__).parent
#: What each kind is, by its name.
TEMPLATES = {
    "tube": "steel tube with a cap plate",
    "solid": "marble cylinder",
    "cylinder": "the same as solid",
    "block": "marble block",
    "mesh": "your own mesh (an Abaqus .inp is written as an example)",
    "arch": "stone arch of eleven voussoirs",
    "statue": "object from the scan or CAD body of --from",
}

# Files of a kind and their templates, where they are other than those of the first ones
_OTHERS = {
    "cylinder": {"case.toml": "solid.toml"},
    "mesh": {"column.inp": "column.inp"},
    "arch": {"study.toml": "arch_study.toml"},
    "statue": {"study.toml": "statue_study.toml"},
}


class _Words(tuple[str, ...]):
    """Words that completion offers; any other is taken, too: DIR, where KIND is left out."""

    def __contains__(self, word: object) -> bool:
        return True


# Heights [m] beyond which a statue's file is rather in another unit
_LOWEST, _HIGHEST = 0.05, 20.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn new`."""
    kinds = "; ".join(f"{name}: {what}" for name, what in TEMPLATES.items())
    parser.add_argument(
        "kind",
        nargs="?",
        choices=_Words(TEMPLATES),
        metavar="KIND",
        help=f"{kinds} (default: tube)",
    )
    parser.add_argument(
        "--from",
        dest="drawn",
        metavar="FILE",
        help="with statue: file of its shape, .stl, .obj, .ply, .step, .iges, .geo or elements",
    )
    parser.add_argument(
        "--unit", "--units", choices=tuple(METRES), help="unit of the lengths in FILE"
    )
    parser.add_argument(
        "--cut-foot",
        type=float,
        metavar="M",
        help="height above the lowest point at which the surface is cut off, to get a flat foot "
        "[m]",
    )
    parser.add_argument(
        "folder",
        nargs="?",
        metavar="DIR",
        help="folder for case.toml and study.toml, made if missing; no file in it is "
        "overwritten; may be left out with statue: then the name of FILE without its ending",
    )


def main(args: argparse.Namespace) -> int:
    """Write the files; returns 0.

    Raises
    ------
    InputError
        one of the files is there already, or the folder cannot be written.
    """
    args.kind, args.folder = _kind_and_folder(args)
    stated = _statue(args)
    for file in write(args.kind, args.folder, stated):
        print(f"wrote {file}")
    print(f"next: fecolumn mesh {Path(args.folder) / 'case.toml'} -o {Path(args.folder) / 'mesh'}")
    print(f"      fecolumn run {Path(args.folder) / 'case.toml'} -o {Path(args.folder) / 'run'}")
    print(
        f"      fecolumn study {Path(args.folder) / 'study.toml'} -o {Path(args.folder) / 'study'}"
    )
    return 0


def _kind_and_folder(args: argparse.Namespace) -> tuple[str, str]:
    """Which of the two words is which, where there is but one.

    Raises
    ------
    InputError
        no such kind, or no folder.
    """
    from fecolumn.foundation.schema import InputError, meant

    kind, folder = args.kind, args.folder
    if folder is None and kind == "statue" and args.drawn:
        return kind, Path(args.drawn).stem
    if folder is None and kind not in TEMPLATES:
        kind, folder = "tube", kind
    if folder is None:
        raise InputError("fecolumn new", "DIR", None, "must be the folder to write into")
    if kind not in TEMPLATES:
        raise InputError(
            "fecolumn new",
            "KIND",
            kind,
            f"must be one of {', '.join(TEMPLATES)}{meant(kind, TEMPLATES)}",
        )
    return kind, folder


def _statue(args: argparse.Namespace) -> dict[str, str]:
    """Lines of the template of a statue and what takes their place, its shape read once.

    Raises
    ------
    InputError
        a shape that cannot be used, or options that do not fit.
    """
    import json
    import os

    from fecolumn.foundation.files import is_file
    from fecolumn.foundation.schema import InputError

    if args.kind != "statue":
        for name, value in (
            ("--from", args.drawn),
            ("--unit", args.unit),
            ("--cut-foot", args.cut_foot),
        ):
            if value is not None:
                raise InputError("fecolumn new", name, value, "is of a statue: fecolumn new statue")
        return {}
    if not args.drawn or not is_file(args.drawn):
        raise InputError(
            "fecolumn new", "--from", args.drawn, "must name the file with the statue's shape"
        )
    from fecolumn.mesh.imported import foot_hint, own_mesh

    file = MeshFile(args.drawn, args.unit or "", None, args.cut_foot)
    if unfit := file.unfit():
        raise InputError("fecolumn new", *unfit)
    if args.cut_foot is not None and not args.cut_foot > 0:
        raise InputError("fecolumn new", "--cut-foot", args.cut_foot, "must be greater than 0 m")
    try:
        own = own_mesh(file)
    except InputError as error:
        found = "" if error.value is None else f"has {error.value}; "
        raise InputError("fecolumn new", "--from", args.drawn, found + error.allowed) from None
    if not own.has_foot:
        raise InputError(
            "fecolumn new", "--from", args.drawn, f"has no flat foot to stand on{foot_hint(file)}"
        )
    print(
        f"{args.drawn}: {own.height:.4g} m high on a foot of {own.foot[0]:.4g} x "
        f"{own.foot[1]:.4g} m, {len(own.mesh.cells)} elements"
    )
    if not args.unit and not _LOWEST <= own.height <= _HIGHEST:
        print("its unit was taken for the metre: --unit mm, cm, in or ft says another")
    path = os.path.relpath(Path(args.drawn).resolve(), Path(args.folder).resolve())
    stated = {'"FILE"    ': json.dumps(path)}
    if args.unit:
        stated['# mesh_unit = "mm"'] = f'mesh_unit = "{args.unit}"'
    if args.cut_foot is not None:
        stated["# cut_foot_m = 0.01"] = f"cut_foot_m = {args.cut_foot!r}"
    return stated


def write(kind: str, folder: Path | str, stated: dict[str, str] | None = None) -> list[Path]:
    """Write the files of a kind into a folder, with other words for some; as of `main`."""
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
                text = (_FOLDER / template).read_text(encoding="utf-8")
                for words, others in (stated or {}).items():
                    text = text.replace(words, others)
                file.write(text)
    except OSError as error:
        raise InputError(
            "fecolumn new", "DIR", str(folder), f"cannot be written ({error.strerror})"
        ) from None
    return [folder / name for name in contents]
