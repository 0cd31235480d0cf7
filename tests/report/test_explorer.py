"""What the page embeds for its explorer is what the study holds, within the size and the deviation
that the page states.
"""

import base64
import json
import re

import h5py
import numpy as np
import pytest
from synthetic_study import ALPHA, DT, write_synthetic
from test_page import Page

from fecolumn.study.report import explorer as explorer_module
from fecolumn.study.report.explorer import explorer_data, packed
from fecolumn.study.report.histories import Trace, read_histories
from fecolumn.study.report.page import write_report
from fecolumn.study.report.sweep import read_sweep

MOTIONS = 9


def write_history(folder, peak: float, duration: float, rows: int = 3000) -> None:
    """A rocking of a given peak [m] as history.h5: a wobble that decays, with the kinks of
    impacts.
    """
    time = np.linspace(0.0, duration, rows)
    size = np.sin(np.pi * time / duration) * np.exp(-time / duration)
    u = np.column_stack(
        [size * np.abs(np.sin(9 * time)), 0.5 * size * np.cos(7 * time), -0.01 * size]
    )
    u *= peak / np.hypot(*u[:, :2].T).max()
    with h5py.File(folder / "history.h5", "w") as file:
        for name, values in {"time": time, "u_top": u, "tilt": np.hypot(*u[:, :2].T) / 1.5}.items():
            file[name] = values


def study(folder, *, names=lambda values: values["motion.source"], without=(), **more):
    """A study of six settings with histories, but for those of the motions named in `without`; its
    folder.
    """

    def also(values, summary):
        result = folder / "out" / "analyses" / summary["case_id"]
        if values["motion.source"] not in without:
            write_history(result, summary["u_max_m"], summary["duration_s"])
        fallen = summary["overturned"]
        return {
            "motion": names(values),
            "u_critical_m": 0.12,
            "critical_tilt_rad": 0.09,
            "overturn_direction_deg": 30.0 if fallen else None,
        }

    return write_synthetic(
        folder, {DT: [0.02, 1e-3], ALPHA: [0, -0.1, -0.2]}, MOTIONS, also=also, **more
    )


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    return study(
        tmp_path_factory.mktemp("explorer") / "study",
        fails=(4,),
        unfinished=(7,),
        names=lambda values: f"{values['motion.source']} </script><b>",
    )


@pytest.fixture(scope="module")
def html(out):
    return write_report(out, files=()).read_text()


@pytest.fixture(scope="module")
def data(html):
    found = re.search(
        r'<script type="application/json" id="explorer-data">(.*?)</script>', html, re.S
    )
    return json.loads(found[1])


def test_page_with_its_script_and_data_is_whole_and_loads_nothing(html):
    page = Page(html)
    assert (
        "explorer-panel" in page.ids
        and "figure-fan" in page.ids
        and "figure-plan" in page.ids
        and "figure-multiples" in page.ids
    )
    assert len(page.ids) == len(set(page.ids))
    assert not re.search(
        r"(?:src|href)=[\"']?(?:https?:)?//|@import|fetch\(|XMLHttpRequest|import\(", html
    )


def test_peaks_and_ends_are_those_of_the_analyses(out, data):
    sweep = read_sweep(out)
    assert (
        len(data["settings"]) == 6
        and len(data["motions"]) == MOTIONS
        and [len(axis["levels"]) for axis in data["axes"]] == [2, 3]
    )
    missing = 0
    for setting in sweep.done:
        levels = [sweep.axes[axis].index(setting.values[axis]) for axis in sweep.varied]
        embedded = next(one for one in data["settings"] if one["levels"] == levels)
        for place, motion in enumerate(sweep.motions):
            run, peak, end = (
                setting.runs.get(motion),
                embedded["peaks"][place],
                embedded["ends"][place],
            )
            if run is None:
                assert peak is end is embedded["histories"][place] is None
                missing += 1
            elif run["overturned"]:
                assert peak is None and data["ends"][end]["word"] == "overturned"
            else:
                assert (
                    peak == pytest.approx(1e3 * run["u_max_m"], rel=1e-3)
                    and data["ends"][end]["word"] == "stood"
                )
    assert missing == 2
    assert data["end_mm"] > max(
        peak for one in data["settings"] for peak in one["peaks"] if peak is not None
    )


def unpacked(text):
    """Time [s], u_top (n, 2) [m] and tilt [rad] of a history in the form of `packed`."""
    content = base64.b64decode(text)
    time, u, tilt = np.frombuffer(content, "<f4", 3) / np.array([65535, 32767, 32767])
    n = (len(content) - 12) // 8
    rows = np.frombuffer(content, "<i2", offset=12 + 2 * n).reshape(3, n)
    return {
        "time": time * np.frombuffer(content, "<u2", n, 12),
        "u_top": u * rows[:2].T,
        "tilt": tilt * rows[2],
    }


def test_embedded_histories_miss_no_row_of_the_stored_ones_by_more_than_the_page_says(
    out, html, data
):
    said = float(re.search(r"miss none by more than ([\d.]+).%", Page(html).text)[1]) / 100
    sweep, compared = read_sweep(out), 0
    for setting in sweep.done:
        levels = [sweep.axes[axis].index(setting.values[axis]) for axis in sweep.varied]
        texts = next(one for one in data["settings"] if one["levels"] == levels)["histories"]
        for place, motion in enumerate(sweep.motions):
            if motion not in setting.runs:
                continue
            drawn = unpacked(texts[place])
            with h5py.File(
                out / "analyses" / setting.runs[motion]["case_id"] / "history.h5"
            ) as file:
                time, u, tilt = (file[name][()] for name in ("time", "u_top", "tilt"))
            scale = min(np.hypot(*u[:, :2].T).max(), 0.12)
            for stored, embedded, largest in (
                (u[:, 0], drawn["u_top"][:, 0], scale),
                (u[:, 1], drawn["u_top"][:, 1], scale),
                (np.hypot(*u[:, :2].T), np.hypot(*drawn["u_top"].T), scale),
                (tilt, drawn["tilt"], min(tilt.max(), 0.09)),
            ):
                # of a time that is rounded, a move of the speed times this
                shift = time[-1] / 65535 / 2
                rounding = (
                    np.abs(np.gradient(stored, time)).max() * shift + np.abs(stored).max() / 32767
                )
                assert (
                    np.abs(np.interp(time, drawn["time"], embedded) - stored).max()
                    < said * largest + 1.1 * rounding
                )
            assert len(drawn["time"]) < len(time) / 2
            compared += 1
    assert compared == 6 * MOTIONS - 2


def test_packed_history_comes_back_to_a_thirty_thousandth_of_its_scale():
    rng = np.random.default_rng(5)
    trace = Trace(
        np.sort(rng.uniform(0, 40, 50)),
        rng.normal(0, 0.03, (50, 2)),
        rng.normal(0, 0.01, 50),
        "",
        (0.1, 0.03),
    )
    back = unpacked(packed(trace))
    for name in ("time", "u_top", "tilt"):
        stored = getattr(trace, name)
        assert np.abs(back[name] - stored).max() < 2e-5 * np.abs(stored).max()


def test_history_thins_further_and_then_motions_are_left_out_where_the_page_has_less_room(
    out, monkeypatch
):
    sweep = read_sweep(out)
    histories = read_histories(sweep)
    whole, words = explorer_data(sweep, histories)
    size = sum(len(text) for one in whole["settings"] for text in one["histories"] if text)
    assert "0.2" in words and "To bound the size" not in words
    for room, there in ((0.7, MOTIONS), (0.1, None)):
        monkeypatch.setattr(explorer_module, "LARGEST_BYTES", int(room * size))
        data, words = explorer_data(sweep, histories)
        assert (
            sum(len(text) for one in data["settings"] for text in one["histories"] if text)
            <= room * size
        )
        kept = sum(
            any(one["histories"][place] for one in data["settings"]) for place in range(MOTIONS)
        )
        assert "0.2" not in words and [one["peaks"] for one in data["settings"]] == [
            one["peaks"] for one in whole["settings"]
        ]
        assert (
            kept == there
            if there
            else 0 < kept < MOTIONS
            and f"holds the histories of {kept} of {MOTIONS} motions" in words
        )


def test_histories_that_cannot_be_read_are_counted_and_the_rest_is_kept(tmp_path):
    out = study(tmp_path / "study", without=("pulse:2",))
    damaged = next(out.glob("analyses/*/history.h5"))
    damaged.write_bytes(damaged.read_bytes()[:300])
    sweep = read_sweep(out)
    histories = read_histories(sweep)
    data, words = explorer_data(sweep, histories)
    assert "7 histories could not be read" in words
    assert (
        sum(text is not None for one in data["settings"] for text in one["histories"])
        == len(histories.traces)
        == 6 * MOTIONS - 7
    )


def test_motions_of_one_name_are_told_apart(tmp_path):
    out = study(tmp_path / "study", names=lambda values: "the same")
    data, _ = explorer_data(read_sweep(out), read_histories(read_sweep(out)))
    assert len(set(data["motions"])) == MOTIONS


def test_many_levels_are_offered_setting_by_setting(tmp_path):
    out = write_synthetic(
        tmp_path / "study", {"contact.friction_coefficient": [0.2 + 0.01 * k for k in range(12)]}, 3
    )
    data, _ = explorer_data(read_sweep(out), read_histories(read_sweep(out)))
    assert data["axes"] == [] and len(data["settings"]) == 12 and len(data["start"]) == 1
