"""integration.dt_s = "auto": the step is chosen by trials of the case's own first impacts."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from small_structures import block, structure

from fecolumn import simulation
from fecolumn.cli import main
from fecolumn.engines import step_choice
from fecolumn.engines.first_impacts import STARTS, TrialResult, change, window_of
from fecolumn.foundation.schema import InputError
from fecolumn.study.plan import plan_of
from fecolumn.study.questions.calibration import RockingCalibration

BLOCK = 'column.shape = "block"\ncolumn.length_m = 0.4\ncolumn.width_m = 0.4\n' + (
    "column.height_m = 1.2\nmaterial.youngs_modulus_pa = 50e9\nmesh.fine_size_m = 0.1\n"
    "mesh.coarse_size_m = 0.2\nmesh.base_size_m = 0.2\ninitial.tilt_rad = 0.05\n"
    "integration.duration_s = 0.5\n"
)


def _case(engine="rigid", duration=1.0, tilt=0.05, dt="auto", **keys):
    """A block released from a tilt."""
    return structure(
        **block(**keys),
        initial={"block": {"tilt_rad": tilt}},
        integration={"engine": engine, "duration_s": duration, "dt_s": dt},
    )


def _summary(folder):
    return json.loads((folder / "summary.json").read_text())


def _rows(landings, end=5.0, step=2e-3):
    """History in which impacts take 1 J at the steps that begin at `landings` [s]."""
    time = np.arange(round(end / step) + 1) * step
    took = np.zeros_like(time)
    for one in landings:
        took[round(one / step) :] -= 1.0
    return {"time": time, "energy/impact": took}


def test_window_ends_between_the_third_impact_and_the_fourth():
    # 1.5 and 1.51 are one impact; a quarter of the time to the next is left out at either end
    found = window_of(_rows([1.0, 1.5, 1.51, 1.8, 2.2, 2.4]), 100.0)
    assert found.impacts == 3 and found.lands == pytest.approx(1.0)
    assert (found.begins, found.ends) == pytest.approx((1.9, 2.1))


def test_window_is_cut_where_impacts_are_late_or_never_end():
    one = window_of(_rows([1.0]), 100.0)
    assert one.impacts == 1 and (one.begins, one.ends) == pytest.approx((1.5, 2.5))
    rattles = window_of(_rows(np.arange(1.0, 4.9, 0.01)), 100.0)
    assert rattles.impacts == 1 and (rattles.begins, rattles.ends) == pytest.approx((2.5, 3.0))
    assert window_of(_rows([]), 100.0) is None
    assert window_of(_rows([10.5], end=12.0), 100.0) is None
    # a millionth of the energy to overturn is no landing
    assert window_of(_rows([1.0]), 2e6) is None


def _result(dt, loss, after=0.1, lost=0, share=True):
    """Of starts with these losses; the largest tilt is 0.2."""
    loss = np.array(loss, dtype=float)
    known = loss if share else np.full_like(loss, np.nan)
    tilt = np.full(loss.size, 0.2)
    return TrialResult(dt, known, loss, np.full(loss.size, after), tilt, lost)


@pytest.mark.parametrize("share", [True, False])
def test_change_is_that_of_the_means_over_the_shorter_step(share):
    scattered, same = [1.1, 1.3, 1.1, 1.3], [1.0] * STARTS
    longer = _result(2e-3, scattered, after=0.102, share=share)
    error = np.sqrt(np.var(scattered, ddof=1) / STARTS)
    assert change(longer, _result(1e-3, same)) == pytest.approx((0.2, 0.02, error))
    fell = _result(1e-3, [], lost=STARTS)
    assert max(change(longer, fell)) == np.inf and change(fell, fell) == (0, 0, 0)
    assert fell.told(True)["loss"] is None and fell.told(True)["lost"] == STARTS


def test_tilt_of_what_is_at_rest_after_its_impacts_is_measured_by_the_largest():
    at_rest = [
        _result(dt, [1.0] * STARTS, after=after) for dt, after in ((2e-3, 3e-9), (1e-3, 1e-9))
    ]
    assert change(*at_rest)[1] == pytest.approx(2e-9 / 0.02)


def test_rattling_before_the_impacts_that_count_is_none():
    rows = _rows([1.0, 1.5, 2.0])
    rows["energy/impact"][round(0.2 / 2e-3) :] -= 0.005
    assert window_of(rows, 100.0).lands == pytest.approx(1.0)


@pytest.mark.long
def test_bodies_without_give_lose_the_same_at_every_step_and_take_the_longest(tmp_path, capsys):
    summary = simulation.run(_case(), tmp_path / "auto")
    chosen = summary["dt_chosen"]
    assert summary["dt_s"] == chosen["dt_s"] == 2e-3 and summary["steps"] == 500
    assert chosen["converged"] and chosen["agrees_at_half"] and chosen["impacts"] == 3
    assert [one["dt_s"] for one in chosen["trials"]] == [2e-3, 1e-3, 1.25e-4]
    assert all(one["loss"] == pytest.approx(1.0, abs=2e-3) for one in chosen["trials"])
    assert chosen["loss_change_shortest"] < 2e-3
    told = capsys.readouterr().err
    assert "choosing integration.dt_s: trials of" in told
    assert "dt_s = auto: 0.002 s, as the loss at the first 3 impacts changes by" in told
    # the same analysis as with the number
    stated = simulation.run(_case(dt=2e-3), tmp_path / "stated", quiet=True)
    assert stated["dt_chosen"] is None
    assert {stated[key] == summary[key] for key in ("case_id", "u_max_m", "energy_j")} == {True}


def test_what_was_interrupted_goes_on_with_the_step_chosen_before(tmp_path, monkeypatch):
    chosen = {"dt_s": 5e-4, "said": "dt_s = auto: 5e-4 s"}

    class Choice:
        def __init__(self, case, *others):
            self.id = case.id

        def chosen(self, say):
            return chosen | {"case_id": self.id}

    monkeypatch.setattr(step_choice, "StepChoice", Choice)
    with pytest.raises(KeyboardInterrupt):
        simulation.run(_case(), tmp_path / "out", quiet=True, stop=lambda: True)
    kept = json.loads((tmp_path / "out" / "case.json").read_text())
    assert kept["case"]["integration"]["dt_s"] == 5e-4
    monkeypatch.setattr(step_choice, "StepChoice", None)
    case, file = simulation.read_folder_case(tmp_path / "out")
    assert case.id == kept["id"] == kept["case_id"]
    summary = simulation.run(_case(), tmp_path / "out", quiet=True)
    assert summary == simulation.run(case, tmp_path / "out", file=file, quiet=True)
    assert summary["dt_s"] == 5e-4 and summary["steps"] == 2000
    assert summary["dt_chosen"] == kept["dt_chosen"]
    # the folder is this case's
    monkeypatch.setattr(step_choice, "StepChoice", Choice)
    with pytest.raises(InputError, match="holds the results of another case"):
        simulation.run(_case(tilt=0.06), tmp_path / "out", quiet=True)


def test_elastic_impacts_that_scatter_are_told_as_not_converged(monkeypatch):
    monkeypatch.setattr(step_choice, "TRIAL_STEPS", (2e-3, 1e-3))
    slender = dict(length_m=0.2, height_m=2.0, youngs_modulus_pa=5e9)
    said = []
    case, chosen = simulation.chosen_step(
        _case("reduced", duration=3.0, tilt=0.03, **slender), "case", say=said.append
    )
    assert case.integration.dt_s == chosen["dt_s"] == 1e-3
    assert not chosen["converged"] and not chosen["agrees_at_half"]
    assert max(chosen["loss_change"], chosen["loss_change_error"]) > chosen["same"]
    assert said[-1] == chosen["said"] and "the shortest tried: NOT converged" in said[-1]


def test_a_step_at_which_only_half_agrees_is_told_as_none_of_the_limit(monkeypatch):
    def result(self, dt, window):
        return _result(dt, [1.0 if dt > 4e-4 else 0.7] * STARTS)

    monkeypatch.setattr(step_choice.StepChoice, "_result", result)
    said = []
    _, chosen = simulation.chosen_step(_case(), "case", say=said.append)
    assert chosen["dt_s"] == 2e-3 and chosen["agrees_at_half"] and not chosen["converged"]
    assert chosen["loss_change_shortest"] == pytest.approx(0.3 / 0.7)
    assert "NOT the limit of short steps: at 0.000125 s the loss changes by 43 %" in said[-1]


def test_where_nothing_lands_the_default_is_taken():
    said = []
    _, chosen = simulation.chosen_step(_case(tilt=0.0, duration=0.2), "case", say=said.append)
    assert chosen["dt_s"] == 1e-3 and chosen["converged"] is None and not chosen["trials"]
    assert said == [
        "dt_s = auto: 0.001 s, the default: nothing lands in the first 0.2 s, so that none was "
        "compared"
    ]


def test_motions_are_delayed_by_parts_of_a_step_and_limit_it(tmp_path):
    rows = "".join(f"{t:.3f},{a:.6f}\n" for t, a in zip(np.arange(0, 1, 0.01), np.ones(100)))
    (tmp_path / "motion.csv").write_text(f"time [s],ax [g]\n{rows}")
    motion = {"source": str(tmp_path / "motion.csv"), "delay_s": 0.25, "resample_s": 5e-4}
    shaken = structure(**block(), motion=motion, integration={"engine": "rigid", "dt_s": "auto"})
    choice = step_choice.StepChoice(shaken, "case", None, lambda: False)
    assert choice._allowed() == [5e-4, 2.5e-4, 1.25e-4]
    case = choice._at(5e-4, 0.5, 1.0)
    assert (case.motion.delay_s, case.integration.dt_s) == pytest.approx((0.25025, 5e-4))
    still = step_choice.StepChoice(_case(), "case", None, lambda: False)._at(1e-3, 0.5, 0.4)
    # after as many steps the first landing, at 0.4 s, comes half a step later in its step
    assert 0.4 / still.integration.dt_s == pytest.approx(400.5)


@pytest.mark.parametrize(
    "text, told",
    [
        (
            BLOCK + 'integration.dt_s = "auto"\nintegration.engine = "full"\n',
            "integration.dt_s = 'auto': is for engine = 'reduced' and 'rigid' alone: where "
            "integration.engine = 'full', state a number such as 0.001",
        ),
        (
            BLOCK + 'integration.dt_s = "auto"\nintegration.engine = "housner"\n',
            "integration.engine = 'housner', state a number such as 0.001",
        ),
        (
            '[podium]\n[integration]\ndt_s = "auto"\nduration_s = 3.0\n',
            "integration.engine = 'podium', state a number such as 0.001",
        ),
        (BLOCK + 'integration.dt_s = "Auto"\n', 'must be a number or "auto"'),
        (BLOCK + "integration.dt_s = 0\n", 'at most 0.1 [s] or "auto"'),
    ],
)
def test_what_chooses_no_step_says_so_in_one_line(tmp_path, capsys, text, told):
    file = tmp_path / "case.toml"
    file.write_text(text)
    assert main(["run", str(file), "-o", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1 and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "dt, axes, key",
    [
        ("auto", {"initial.block.tilt_rad": [0.05, 0.06]}, "case.integration.dt_s"),
        (1e-3, {"integration.dt_s": [1e-3, "auto"]}, "axes.integration.dt_s"),
    ],
)
def test_what_is_compared_has_one_step_that_is_stated(tmp_path, dt, axes, key):
    tables = {"case": _case(dt=dt).tables(), "axes": axes}
    with pytest.raises(InputError, match="many that are compared have one step: state the number"):
        plan_of(tables, tmp_path / "study.toml")
    with pytest.raises(InputError, match=key):
        plan_of(tables, tmp_path / "study.toml")


def test_a_fit_has_one_step_that_is_stated(tmp_path):
    test = SimpleNamespace(time=np.array([0.0, 0.5]), tilt=np.array([0.05, 0.0]))
    fit = RockingCalibration(
        _case().tables(), "case", {"contact.friction_coefficient": (0.3, 0.5)}, test, tmp_path
    )
    with pytest.raises(InputError, match="integration.dt_s = 'auto': is for one analysis"):
        fit.check()
