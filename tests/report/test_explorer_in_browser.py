"""The explorer as a reader uses it: the page of a real study opened from its file in Chromium, by
keyboard and by mouse.
"""

import json
import re

import pytest
from chromium import MISSING, chromium, open_page

from fecolumn.cli import main
from fecolumn.study.report.page import write_report

if not MISSING:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

STUDY = """
title = "Blocks and friction"
[case.column]
shape = "block"
length_m = 0.1
width_m = 0.1
height_m = 0.8
[case.material]
youngs_modulus_pa = 50e9
density_kg_m3 = 2700
[case.mesh]
fine_size_m = 0.05
coarse_size_m = 0.1
base_size_m = 0.1
[case.integration]
engine = "rigid"
dt_s = 2e-3
[case.motion]
source = "motion0.csv"
free_vibration_s = 1.0
[axes]
"contact.friction_coefficient" = [0.3, 0.7]
"motion.source" = ["motion0.csv", "motion1.csv", "motion2.csv", "motion3.csv", "motion4.csv"]
"""


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """The page of a study of five pulses, the first so weak that the block stands, the last so
    strong that it overturns.
    """
    folder = tmp_path_factory.mktemp("browser")
    for number, scale in enumerate((0.16, 0.2, 0.25, 0.3, 3.0)):
        rows = "".join(
            f"{0.005 * k:.4f},{scale if k < 12 else -scale:.3f},{0.05 * scale * (k % 7):.4f}\n"
            for k in range(24)
        )
        (folder / f"motion{number}.csv").write_text("time [s],ax [g],ay [g]\n" + rows)
    (folder / "study.toml").write_text(STUDY)
    assert main(["study", str(folder / "study.toml"), "-o", str(folder / "out"), "-j", "1"]) == 0
    return write_report(folder / "out", files=()).as_uri()


@pytest.fixture(scope="module")
def browser():
    with chromium() as window:
        yield window


class Reader:
    """What a reader sees and does on the page, in a window of a size in pixels."""

    def __init__(self, window, address: str, width: int, height: int):
        self.window = window
        open_page(window, address, width, height)
        self.data = json.loads(
            self.script("return document.getElementById('explorer-data').textContent")
        )

    def script(self, words: str):
        return self.window.execute_script(words)

    def part(self, name: str):
        return self.window.find_element("id", f"explorer-{name}")

    def press(self, *keys: str) -> None:
        """Keys go to what has the focus."""
        ActionChains(self.window).send_keys(*keys).perform()

    @property
    def focus(self) -> str:
        return self.window.switch_to.active_element.get_attribute("id")

    def motions(self) -> list[str]:
        return [button.text for button in self.part("list").find_elements("css selector", "button")]

    def lines(self, name: str) -> list[str]:
        """Points of the lines of a chart that are not black (foot and critical displacement
        are).
        """
        return [
            one.get_attribute("points")
            for one in self.part(name).find_elements("css selector", "polyline")
            if one.get_attribute("stroke") != "#000000"
        ]

    def edges(self) -> tuple[float, float]:
        """Range marked, as the page says it [mm]; infinite for what was lost."""
        return tuple(
            float("inf") if "mm" not in text else float(text.split()[0])
            for text in (self.part("from-text").text, self.part("to-text").text)
        )

    def in_range(self) -> set[str]:
        """Motions with a peak in the range in any setting that is drawn, from the data alone."""
        low, high = self.edges()
        found = set()
        for one in (self.data["settings"][place] for place in self.data["start"]):
            for motion, peak, end in zip(self.data["motions"], one["peaks"], one["ends"]):
                if high == float("inf") and end or peak is not None and low <= peak <= high:
                    found.add(motion)
        return found

    def fits(self) -> bool:
        """No part of the explorer sticks out, and the page need not be scrolled sideways."""
        outside = self.script(
            "return [...document.querySelectorAll('#explorer-panel > *, "
            "#explorer-panel svg')].filter((one) => one.getBoundingClientRect().right"
            " > document.documentElement.clientWidth + 1).length"
        )
        return outside == 0 and self.script(
            "return document.documentElement.scrollWidth <= document.documentElement.clientWidth"
        )

    def faults(self) -> list:
        """Errors of the console, and what was asked for besides the page."""
        asked = self.script(
            "return performance.getEntriesByType('resource').map((one) => "
            "one.name).filter((name) => !name.startsWith('data:'))"
        )
        return [
            entry
            for entry in self.window.get_log("browser")
            if entry["level"] in ("SEVERE", "WARNING")
        ] + asked


@pytest.mark.parametrize("width, height", [(1200, 900), (390, 844)])
def test_a_reader_with_a_keyboard_finds_the_histories_of_a_motion(browser, address, width, height):
    page = Reader(browser, address, width, height)
    assert page.fits() and len(page.motions()) == 5 and len(page.lines("cdf")) == 2
    page.script("document.querySelector('#explorer-settings input').focus()")
    page.press(Keys.SPACE)
    assert len(page.lines("cdf")) == 1 and "0.7" in page.part("legend").text
    page.press(Keys.SPACE, Keys.TAB, Keys.TAB)
    assert len(page.lines("cdf")) == 2
    while page.focus != "explorer-from":
        page.press(Keys.TAB)
    outline = page.script("return getComputedStyle(document.activeElement).outlineWidth")
    assert float(outline.removesuffix("px")) >= 2  # the focus is seen
    page.press(*[Keys.ARROW_RIGHT] * 10, Keys.TAB, Keys.END, *[Keys.ARROW_LEFT] * 40)
    low, high = page.edges()
    assert 0 < low < high < page.data["end_mm"]
    assert set(page.motions()) == page.in_range() != set() and len(page.motions()) < 5
    assert page.part("to").get_attribute("aria-valuetext") == page.part("to-text").text
    page.press(Keys.TAB)
    before = page.window.switch_to.active_element.text
    if len(page.motions()) > 1:
        page.press(Keys.ARROW_DOWN)
        assert page.window.switch_to.active_element.text != before
    assert not page.part("top").is_displayed()
    chosen = page.window.switch_to.active_element.text
    page.press(Keys.ENTER)
    assert (
        page.part("motion").text.startswith(chosen)
        and page.window.switch_to.active_element.get_attribute("aria-pressed") == "true"
    )
    assert all(
        page.part(name).is_displayed()
        and len(page.lines(name)) == 2
        and min(map(len, page.lines(name))) > 200
        for name in ("top", "tilt", "plan")
    )
    for name, unit in (
        ("cdf", "[mm]"),
        ("top", "[mm]"),
        ("top", "[s]"),
        ("tilt", "[°]"),
        ("plan", "[mm]"),
    ):
        assert unit in page.part(name).text
    assert page.fits() and page.faults() == []


def test_a_reader_with_a_mouse_marks_what_overturned_and_sees_where_it_ended(browser, address):
    page = Reader(browser, address, 1200, 900)
    plot = page.part("cdf")
    page.script("document.getElementById('explorer-cdf').scrollIntoView({block: 'center'})")
    half = plot.size["width"] / 2
    ActionChains(browser).move_to_element_with_offset(
        plot, half - 60, 0
    ).click_and_hold().move_to_element_with_offset(plot, half - 16, 5).release().perform()
    low, high = page.edges()
    assert (
        0 < low < page.data["end_mm"]
        and high == float("inf")
        and set(page.motions()) == page.in_range() != set()
    )
    lost = next(
        button
        for button in page.part("list").find_elements("css selector", "button")
        if button.text == page.data["motions"][-1]
    )
    lost.click()
    assert page.part("top").find_elements("css selector", "path.end") and page.part(
        "plan"
    ).find_elements("css selector", "path.end")
    assert "A cross: overturned, followed up to" in page.part("marks").text
    # ticks, of time and of displacement
    followed = [float(text) for text in page.part("top").text.split() if text.isdigit()]
    assert max(followed) < 1.3 * max(page.data["end_mm"], page.data["critical_mm"])
    drawn = page.lines("top")
    page.window.find_element("css selector", "#explorer-quantity option[value='1']").click()
    assert page.lines("top") != drawn and re.search(
        r"u\s*x \[mm\]", page.part("top").text.replace("\n", " ")
    )
    ActionChains(browser).move_to_element_with_offset(
        plot, 0, 0
    ).click().perform()  # without a drag: all again
    assert len(page.motions()) == 5 and page.faults() == []


def test_nothing_of_the_explorer_is_printed(browser, address):
    page = Reader(browser, address, 1200, 900)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    assert not page.part("panel").is_displayed()
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert page.part("panel").is_displayed() and page.fits() and page.faults() == []
