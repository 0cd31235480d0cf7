"""The page of a motion as a reader uses it: opened from its file in Chromium."""

import numpy as np
import pytest
from chromium import SOLID, chromium, open_page

from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.page.document import times_of
from fecolumn.pictures.render.page.flexure import flexure_of
from fecolumn.pictures.render.page.parts import parts_of
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result

pytest.importorskip("k3d", reason="k3d is not installed: pip install 'k3d>=2.18,<3'")
TOP = "const part = motionPage.parts[0].drawn[0]; part.updateMatrixWorld(true);"


@pytest.fixture(scope="module")
def window():
    with chromium(SOLID) as window:
        yield window


@pytest.fixture(scope="module")
def page(gate):
    (file,) = render(gate, RenderOptions(html=True), quiet=True)
    return file.as_uri()


def _opened(window, page: str, width: int):
    from selenium.webdriver.support.ui import WebDriverWait

    open_page(window, page, width, 800)
    ready = "return document.documentElement.dataset.ready === 'true'"
    WebDriverWait(window, 60).until(lambda one: one.execute_script(ready))
    return window.execute_script


@pytest.mark.parametrize("width", [1200, 400])
def test_page_fits_the_window_and_asks_for_nothing(window, page, width):
    script = _opened(window, page, width)
    assert script("return document.documentElement.scrollWidth") <= width
    wide, tall = script(
        "const box = document.querySelector('#scene canvas').getBoundingClientRect();"
        "return [box.width, box.height]"
    )
    assert wide > 0.6 * width and tall > 300
    sent = script("return performance.getEntriesByType('resource').map((one) => one.name)")
    assert not [one for one in sent if not one.startswith(("data:", "blob:"))]
    assert not [one for one in window.get_log("browser") if one["level"] == "SEVERE"]


def test_the_slider_moves_the_bodies_to_where_the_history_has_them(window, page, gate):
    script = _opened(window, page, 1200)
    script(
        "const slider = document.getElementById('time'); slider.value = 0.06;"
        "slider.dispatchEvent(new Event('input'));"
    )
    result = read_result(gate)
    pose = result.poses[0].at(np.array([0.06]))
    matrix = np.reshape(script(TOP + "return part.matrixWorld.elements.slice()"), (4, 4)).T
    assert matrix[:3, :3] == pytest.approx(pose.rotation[0], abs=1e-6)
    assert matrix[:3, 3] == pytest.approx(pose.foot[0], abs=1e-6)
    assert script("return document.getElementById('clock').textContent") == "t = 0.060 s"
    # ten times the displacements and the turn
    script(
        "const key = document.getElementById('magnified'); key.value = 10;"
        "key.dispatchEvent(new Event('change'));"
    )
    matrix = np.reshape(script(TOP + "return part.matrixWorld.elements.slice()"), (4, 4)).T
    moved = pose.origin + 10 * (pose.foot[0] - pose.origin)
    assert matrix[:3, 3] == pytest.approx(moved, abs=1e-5)
    angle = np.arccos((np.trace(pose.rotation[0]) - 1) / 2)
    assert np.arccos((np.trace(matrix[:3, :3]) - 1) / 2) == pytest.approx(10 * angle, rel=1e-3)
    assert "\u00d710" in script("return document.getElementById('said').textContent")


def test_play_goes_to_the_end_and_forces_can_be_hidden(window, page):
    from selenium.webdriver.support.ui import WebDriverWait

    script = _opened(window, page, 1200)
    seen = "return motionPage.arrows.filter((one) => one.drawn.visible).length"
    assert script(seen) > 0
    script("document.getElementById('forces').click()")
    assert script(seen) == 0
    script("document.getElementById('play').click()")
    WebDriverWait(window, 30).until(
        lambda one: one.execute_script("return motionPage.time >= motionPage.end - 1e-9")
    )
    assert script("return document.getElementById('play').textContent") == "Play"


def test_deformation_is_magnified_and_pressure_can_be_hidden(window, page, gate):
    """Points of the mesh move by the factor times what the first part of the page tells."""
    script = _opened(window, page, 1200)
    result = read_result(gate)
    times = times_of(result, (result.time[0], result.time[-1]), 1.0)
    parts = parts_of(result, times)
    flexure = flexure_of(result, parts, times)
    k = len(flexure.times) // 2
    one = flexure.deformations[0]
    bent = np.einsum("r,rna->na", one.shares[k], one.shapes)
    moved = (
        "const key = document.getElementById('bent'); key.value = 1000;"
        "key.dispatchEvent(new Event('change')); motionPage.show(arguments[0]);"
        "return [...motionPage.parts[0].drawn[0].geometry.attributes.position.array]"
    )
    found = np.reshape(script(moved, float(flexure.times[k])), (-1, 3))
    assert np.abs(bent).max() > 0
    assert found == pytest.approx(parts[0].points + 1e3 * bent, abs=20 * np.abs(bent).max())
    assert "deformation \u00d71000" in script("return document.getElementById('said').textContent")
    seen = "return motionPage.flexure.faces.filter((one) => one.drawn.visible).length"
    assert script(seen) > 0
    script("document.getElementById('pressure').click()")
    assert script(seen) == 0
