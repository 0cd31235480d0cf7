"""Debian's Chromium, driven by selenium: pages are opened from their files as a reader does."""

import contextlib
import importlib.util
import os
import shutil
import tempfile

import pytest

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
MISSING = (
    ""
    if CHROMIUM and DRIVER and importlib.util.find_spec("selenium")
    else (
        "needs Debian's chromium and chromium-driver, and selenium: ./containers/run "
        "pytest installs them"
    )
)
# Chromium asks the network for nothing, and takes a container's small /dev/shm
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
)
# With and without drawings in three dimensions, which no graphics card has to make
FLAT = ("--disable-gpu",)
SOLID = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@contextlib.contextmanager
def chromium(graphics=FLAT):
    """A window; the test is skipped, or fails in CI, where there is none."""
    if MISSING:
        (pytest.fail if os.environ.get("CI") else pytest.skip)(MISSING)
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    # Chromium's last child may still write
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        for option in (*OPTIONS, *graphics, f"--user-data-dir={profile}"):
            options.add_argument(option)
        window = webdriver.Chrome(options, webdriver.ChromeService(DRIVER))
        yield window
        window.quit()


def open_page(window, address: str, width: int, height: int) -> None:
    """Open a page in a window of a size in pixels, a phone's where it is narrow."""
    window.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500},
    )
    window.get(address)
