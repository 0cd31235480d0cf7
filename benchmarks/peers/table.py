"""The comparison as a Markdown table: made of the records of `peer.record` alone."""

from __future__ import annotations

HEAD = (
    "program",
    "dofs",
    "CPU s a step",
    "iterations",
    "steps",
    "impacts passed",
    "off theory, worst",
    "toe creep [µm]",
    "energy kept / theory",
    "remark",
)


def remark(record: dict) -> str:
    """How the run ended."""
    if record["reason"]:
        return record["reason"]
    words = record["last_words"]
    if "steps" not in record:
        return f"no step made: {words}"
    reached = f"reached {record['reached_s']:.3f} s"
    if record["timed_out"]:
        return f"CPU limit; {reached}"
    if not record["converged"]:
        return f"does not converge; {reached}"
    if record["steps"] < record["asked_steps"]:
        return f"stops, code {record['code']}; {reached}: {words}"
    if record["code"]:
        return f"code {record['code']}: {words}"
    return (
        "converged"
        if len(record["impacts_s"]) >= len(record["theory_s"])
        else f"converged; {reached} asked for"
    )


def row(record: dict) -> tuple[str, ...]:
    """Cells of a record, as HEAD."""
    who = f"{record['peer']} ({record['version']})" if record["version"] else record["peer"]
    if "steps" not in record:
        return (who, f"{record['dofs']:,}", *["-"] * 7, remark(record))
    passed = min(len(record["impacts_s"]), len(record["theory_s"]))
    off = max(
        (abs(found / exact - 1) for found, exact in zip(record["impacts_s"], record["theory_s"])),
        default=None,
    )
    kept, creep = record["energy_kept"], record["toe_creep_m"]
    return (
        who,
        f"{record['dofs']:,}",
        _cell(record["cpu_s_per_step"], "{:.2g}"),
        _cell(record["iterations_per_step"], "{:.1f}"),
        f"{record['steps']:,}",
        f"{passed}",
        _cell(off, "{:.2%}"),
        _cell(creep and 1e6 * creep, "{:.2g}"),
        f"{_cell(kept, '{:.4f}')} / {record['theory_energy_kept']:.4f}",
        remark(record),
    )


def _cell(value, form: str) -> str:
    return "-" if value is None else form.format(value)


def table(records: list[dict]) -> str:
    """Markdown table of records."""
    rows = [HEAD, *(row(record) for record in records)]
    widths = [max(len(cells[k]) for cells in rows) for k in range(len(HEAD))]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(cells, widths)) + " |"
        for cells in rows
    ]
    return "\n".join(
        [lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]]
    )


def ratios(records: list[dict]) -> list[str]:
    """How many times faster a step this project's finite-element engines are than the fastest
    finite-element peer that made steps.
    """
    timed = [record for record in records if record.get("cpu_s_per_step")]
    fastest = min(
        (record for record in timed if record["elements"]),
        key=lambda record: record["cpu_s_per_step"],
        default=None,
    )
    return [
        f"{record['peer']}: {fastest['cpu_s_per_step'] / record['cpu_s_per_step']:,.0f} "
        f"times as fast a step as {fastest['peer']}"
        for record in timed
        if fastest and record["name"] in ("full", "reduced")
    ]
