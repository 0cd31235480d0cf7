"""Links of a structure from case to results: their columns with units, extremes and times in the
summary, limits in the mesh's table, their term of the energy ledger, their figure.
"""

import warnings

import h5py
import numpy as np
import pytest
from small_structures import block, structure

from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.toml_file import merge
from fecolumn.pictures.figures.history_figures import has_figures, history_figures
from fecolumn.pictures.mesh_report import mesh_report
from fecolumn.simulation import run
from fecolumn.study.results.analysis import AnalysisResult

UNITS = dict(tension="N", elongation="m", yielded="m", work="J", broken="-")
TOP = dict(body="block", point_m=[0, 0, 1.0])
# a block set rocking by a spin about y: towards +x first, and back over its other edge
ROCKING = merge(
    block(element_size_m=0.2, coarse_size_m=0.4),
    dict(
        links=dict(
            tendon=dict(
                kind="tendon",
                body="block",
                point_m=[0, 0, 1.2],
                to_point_m=[0, 0, 0],
                stiffness_n_m=1e6,
                prestress_n=500.0,
                yield_n=2e3,
            ),
            fuse=TOP | dict(kind="spring", to_point_m=[-1, 0, 1.0], stiffness_n_m=1e5, yield_n=1e3),
            wire=TOP
            | dict(
                kind="restrainer",
                to_point_m=[-1, 0, 1.0],
                stiffness_n_m=5e4,
                slack_m=0.01,
                breaking_n=400.0,
            ),
            damper=TOP | dict(kind="dashpot", to_point_m=[-1, 0, 1.0], damping_n_s_m=500.0),
            still=TOP | dict(kind="spring", to_point_m=[0, 9, 1.0], stiffness_n_m=1e2),
        ),
        initial=dict(block=dict(spin_rad_s=[0, 0.9, 0])),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(dt_s=1e-3, duration_s=0.6),
    ),
)


@pytest.fixture(scope="module")
def rocking(tmp_path_factory):
    folder = tmp_path_factory.mktemp("links") / "run"
    return (
        folder,
        run(structure(**ROCKING), folder, quiet=True),
        read_history(folder / "history.h5"),
    )


def test_history_has_columns_of_each_link_with_their_units(rocking):
    folder, _, _ = rocking
    with h5py.File(folder / "history.h5") as file:
        assert list(file["link"]) == sorted(ROCKING["links"])
        assert {
            name: {what: values.attrs["unit"] for what, values in link.items()}
            for name, link in file["link"].items()
        } == dict.fromkeys(ROCKING["links"], UNITS)
    assert AnalysisResult(folder).units["link/fuse/tension"] == "N"


def test_what_links_take_is_a_term_of_its_own_and_the_balance_closes(rocking):
    _, summary, rows = rocking
    works = sum(rows[f"link/{name}/work"] for name in ROCKING["links"])
    np.testing.assert_allclose(-rows["energy/links"], works, rtol=1e-12, atol=1e-12)
    assert (
        summary["energy_j"]["links"] == rows["energy/links"][-1] < -10.0
        and not rows["energy/damping"].any()
        and summary["energy_closure_rel"] < 1e-12
    )
    assert works[0] == 0.0


def test_columns_follow_the_law_of_each_link(rocking):
    _, _, rows = rocking
    links = {
        name: {what: rows[f"link/{name}/{what}"] for what in UNITS} for name in ROCKING["links"]
    }
    tendon, fuse, wire, damper = (links[name] for name in ("tendon", "fuse", "wire", "damper"))
    # a prestress is there from the start, from the elongation P / k on
    assert tendon["tension"][0] == pytest.approx(500.0, rel=0.01) and tendon["elongation"][
        0
    ] == pytest.approx(5e-4, rel=0.01)
    np.testing.assert_allclose(
        tendon["tension"], 1e6 * np.maximum(tendon["elongation"] - tendon["yielded"], 0), atol=1e-6
    )
    np.testing.assert_allclose(
        fuse["tension"], 1e5 * (fuse["elongation"] - fuse["yielded"]), atol=1e-6
    )
    assert tendon["tension"].max() == pytest.approx(2e3, rel=1e-12) and np.abs(
        fuse["tension"]
    ).max() == pytest.approx(1e3, rel=1e-12)
    for link, force in ((tendon, 2e3), (fuse, 1e3)):
        assert (
            link["work"][-1]
            == pytest.approx(force * np.abs(np.diff(link["yielded"])).sum(), rel=1e-9)
            and link["work"][-1] > 1.0
        )
    broken = wire["broken"] == 1
    assert (
        broken.any()
        and not wire["tension"][broken].any()
        and wire["work"][-1] == pytest.approx(400.0**2 / 2 / 5e4, rel=0.1)
    )
    np.testing.assert_allclose(
        wire["tension"][~broken], 5e4 * np.maximum(wire["elongation"][~broken] - 0.01, 0), atol=1e-6
    )
    # of a dashpot the mean over each step
    np.testing.assert_allclose(
        damper["tension"][1:], 500.0 * np.diff(damper["elongation"]) / 1e-3, rtol=1e-6, atol=1e-6
    )


def test_summary_tells_extremes_and_when_each_yielded_broke_and_went_slack(rocking):
    _, summary, rows = rocking
    links = summary["links"]
    assert list(links) == list(ROCKING["links"])
    for name, link in links.items():
        tension, time = rows[f"link/{name}/tension"], rows["time"]
        assert (
            link["tension_max_n"] == tension.max()
            and link["tension_min_n"] == tension.min()
            and link["work_j"] == rows[f"link/{name}/work"][-1]
        )
        yielded, broken = rows[f"link/{name}/yielded"] != 0, rows[f"link/{name}/broken"] == 1
        assert link["yielded_at_s"] == (
            time[np.argmax(yielded)] if yielded.any() else None
        ) and link["broke_at_s"] == (time[np.argmax(broken)] if broken.any() else None)
        assert link["elongation_max_m"] == rows[f"link/{name}/elongation"][~broken].max()
    assert (
        links["fuse"]["slack_at_s"] is None
        and links["damper"]["slack_at_s"] is None
        and links["wire"]["slack_at_s"] is None
    )
    slack = links["tendon"]["slack_at_s"]
    assert (
        links["tendon"]["yielded_at_s"] < slack
        and rows["link/tendon/tension"][rows["time"] == slack]
        == 0.0
        < rows["link/tendon/tension"][rows["time"] < slack].min()
    )
    assert {links["still"][name] for name in ("yielded_at_s", "broke_at_s", "slack_at_s")} == {
        None
    } and links["still"]["work_j"] == 0.0


def test_rows_of_the_history_may_be_far_apart(rocking, tmp_path):
    """Extremes and times are of every step, whatever is written."""
    again = run(
        structure(**merge(ROCKING, dict(output=dict(history_every_s=0.05)))),
        tmp_path / "run",
        quiet=True,
    )
    assert again["links"] == rocking[1]["links"]


def test_interrupted_analysis_goes_on_with_what_its_links_have_taken(rocking, tmp_path):
    asked = []

    def stop():
        asked.append(0)
        return len(asked) == 1

    with pytest.raises(KeyboardInterrupt):
        run(structure(**ROCKING), tmp_path / "run", quiet=True, stop=stop)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of a checkpoint that cannot be used
        summary = run(structure(**ROCKING), tmp_path / "run", quiet=True)
    for name, link in rocking[1]["links"].items():
        for entry, value in link.items():
            assert summary["links"][name][entry] == (
                value if value is None else pytest.approx(value, rel=1e-6, abs=1e-9)
            ), f"{name} {entry}"


@pytest.mark.long
def test_figures_have_a_panel_of_each_link(rocking):
    folder, _, _ = rocking
    assert not has_figures(folder)
    files = {file.name for file in history_figures(folder)}
    # five links, three a figure
    assert {"links.png", "links.pdf", "links_2.png", "links_2.pdf"} <= files and has_figures(folder)
    assert AnalysisResult(folder).plot.links("fuse")._repr_png_().startswith(b"\x89PNG")


def test_mesh_lists_length_stiffness_prestress_and_where_each_yields_and_breaks(tmp_path):
    table = mesh_report(structure(**ROCKING), "case.toml", tmp_path / "mesh").splitlines()
    head = next(line for line in table if line.startswith("link"))
    columns = [
        "length [m]",
        "stiffness [N/m]",
        "damping [N s/m]",
        "prestress [N]",
        "slack [m]",
        "yields [N]",
        "at [m]",
        "breaks [N]",
        "at [m]",
        "hardening [-]",
        "exponent [-]",
    ]
    assert head.split("between")[1].split() == " ".join(columns).split()
    rows = {line.split()[1]: line.split()[5:] for line in table[table.index(head) + 1 :]}
    assert rows["tendon"] == ["1.2", "1e+06", "0", "500", "0", "2000", "0.002", "-", "-", "0", "-"]
    assert rows["fuse"] == ["1", "1e+05", "0", "0", "0", "1000", "0.01", "-", "-", "0", "-"]
    # beyond its slack
    assert rows["wire"] == ["1", "50000", "0", "0", "0.01", "-", "-", "400", "0.018", "0", "-"]
    assert rows["damper"] == ["1", "0", "500", "0", "0", "-", "-", "-", "-", "0", "-"]


def test_full_order_tells_the_same_of_links(tmp_path):
    short = merge(ROCKING, dict(integration=dict(engine="full", duration_s=0.15)))
    summary = run(structure(**short), tmp_path / "full", quiet=True)
    rows = read_history(tmp_path / "full" / "history.h5")
    reduced = run(
        structure(**merge(short, dict(integration=dict(engine="reduced", n_modes=1000)))),
        tmp_path / "reduced",
        quiet=True,
    )
    others = read_history(tmp_path / "reduced" / "history.h5")
    assert (
        set(rows) == set(others)
        and rows["link/wire/broken"].dtype.kind == others["link/wire/broken"].dtype.kind == "i"
    )
    for name in ROCKING["links"]:
        for what in UNITS:
            values = others[f"link/{name}/{what}"]
            np.testing.assert_allclose(
                rows[f"link/{name}/{what}"],
                values,
                rtol=0,
                atol=1e-4 * max(np.abs(values).max(), 1e-6),
                err_msg=f"{name} {what}",
            )
        assert (
            summary["links"][name]["yielded_at_s"] == reduced["links"][name]["yielded_at_s"]
            and summary["links"][name]["broke_at_s"] == reduced["links"][name]["broke_at_s"]
        )
    np.testing.assert_allclose(
        -rows["energy/links"],
        sum(rows[f"link/{name}/work"] for name in ROCKING["links"]),
        rtol=1e-12,
        atol=1e-12,
    )
    assert (
        rows["energy/links"][0] == 0.0
        and rows["energy/links"][-1] < -1.0
        and summary["energy_closure_rel"] < 1e-9
    )
