"""`fecolumn show`: the full form of a case, which runs to the same digits as the short one."""

from __future__ import annotations


def add_arguments(parser) -> None:
    """Arguments of `fecolumn show`."""
    parser.add_argument("case", metavar="CASE.toml")
    parser.add_argument("--all", action="store_true", help="keys at their defaults, too")


def main(args) -> int:
    """Print the full form; returns 0.

    Raises
    ------
    InputError
        the file holds no case.
    """
    import tomli_w

    from fecolumn.case.case import read_case

    print(tomli_w.dumps(full_form(read_case(args.case), args.all)), end="")
    return 0


def full_form(case, defaults: bool = False) -> dict:
    """Tables of the full form of a case, as its file would have them.

    Parameters
    ----------
    defaults
        keys at their defaults, too.
    """
    tables = case.tables(defaults, arches=False)
    tables["joints"] = {name: _joint(table) for name, table in tables.pop("joints").items()}
    return tables


def _joint(table: dict) -> dict:
    """A joint by the two that touch, whichever of them is called the slave."""
    others = {key: value for key, value in table.items() if key not in ("slave", "on", "between")}
    return {"between": [table["slave"], table["on"]], **others}
