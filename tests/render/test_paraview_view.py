"""ParaView opens the fields as a time series whose names have their units, and the script sets up the view."""

import shutil
import subprocess

import numpy as np
import pytest

from fecolumn.cli import main


def test_fields_are_a_time_series_with_units_in_their_names(drum):
    import pyvista

    reader = pyvista.get_reader(str(drum / "fields" / "fields.xdmf"))
    assert reader.time_values == pytest.approx(np.arange(0, 0.25, 0.04))
    reader.set_active_time_value(reader.time_values[-1])
    grid = reader.read()
    assert set(grid.point_data) == {"displacement [m]", "contact pressure [Pa]"} and set(grid.cell_data) == {"von Mises stress [Pa]", "part"}
    assert 0.01 < np.linalg.norm(grid.point_data["displacement [m]"], axis=1).max() < 1.6


def test_script_is_of_this_analysis_and_finds_its_fields_from_where_it_is(drum):
    assert main(["render", str(drum), "--paraview"]) == 0
    text = (drum / "render" / "view.py").read_text()
    compile(text, "view.py", "exec")
    assert "@" not in text and str(drum) not in text and 'os.pardir, "fields", "fields.xdmf"' in text
    assert (drum / "render" / ".." / "fields" / "fields.xdmf").is_file()


@pytest.mark.verification
@pytest.mark.skipif(not (shutil.which("pvbatch") and shutil.which("xvfb-run")), reason="Debian's paraview, python3-paraview and xvfb are not installed")
def test_pvbatch_draws_the_instant_asked_for(drum, tmp_path):
    from PIL import Image

    assert main(["render", str(drum), "--paraview"]) == 0
    pictures = []
    for time in ("0", "0.2"):
        file = tmp_path / f"{time}.png"
        subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", "pvbatch", drum / "render" / "view.py", file, time], check=True, timeout=300)
        pictures.append(np.asarray(Image.open(file).convert("RGB"), float))
    assert pictures[0].shape == (720, 1280, 3) and np.abs(pictures[0] - pictures[1]).mean() > 0.5
