"""The pages that the program writes, in a real browser: light and dark, on a phone, by keyboard, without a mouse.

EXCAVATOR_PICTURES=FOLDER keeps pictures of all pages. EXCAVATOR_AXE is the folder of the npm package axe-core; without it
accessibility is not checked.
"""

import base64
import os
import subprocess
from pathlib import Path

import pytest
from browser import Browser

REPOSITORY = Path(__file__).resolve().parents[2]
SAMPLES = REPOSITORY / "bags" / "samples"
LAW = SAMPLES / "hidden-law"
BOTH = ["--identification", LAW / "identification", "--validation", LAW / "validation"]
PAGES = {
    "comparison": ["compare", "--model", "zx30u-arm", "--bag", LAW / "validation", "--repeat", LAW / "identification"],
    "energy": ["energy", "--model", "zx30u-arm", "--bag", LAW / "validation"],
    "characterisation": ["characterise", "--model", "zx30u-arm", LAW / "validation"],
    "diagnosis": ["diagnose", "--model", "zx30u-arm", *BOTH],
    "refinement": ["refine", "--model", "zx30u-arm", *BOTH, "--add", "stribeck_friction@arm", "-o", "refined.toml"],
}
MOST_BYTES = 1_000_000
WIDE, PHONE = (1280, 900), (390, 844)
READY = "document.readyState === 'complete' && (!document.querySelector('.time-plot') || !!document.querySelector('.uplot'))"


@pytest.fixture(scope="module")
def pages(excavator, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    for name, words in PAGES.items():
        command = [excavator, *words, "--report", f"{name}.html"]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert result.returncode == 0, f"{name}: {result.stderr}"
    return folder


@pytest.fixture(scope="module")
def browser(chromium, tmp_path_factory):
    with Browser(chromium, tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@pytest.fixture(params=PAGES)
def page(request, pages, browser):
    browser.errors.clear()
    browser.screen(*WIDE)
    browser.open((pages / f"{request.param}.html").as_uri())
    browser.wait_for(READY, f"the page of {request.param}")
    yield request.param
    assert browser.errors == []


def keep(browser, name):
    folder = os.environ.get("EXCAVATOR_PICTURES")
    if folder:
        Path(folder).mkdir(parents=True, exist_ok=True)
        (Path(folder) / f"{name}.png").write_bytes(base64.b64decode(browser.picture(whole=True)))


def test_pages_are_small_and_need_nothing_else(page, pages):
    text = (pages / f"{page}.html").read_text()
    assert len(text.encode()) < MOST_BYTES
    assert "<link" not in text and "src=" not in text


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_page_follows_the_scheme_of_the_system(page, browser, scheme):
    browser.screen(*WIDE, scheme)
    ground = browser.value("getComputedStyle(document.querySelector('main')).backgroundColor")
    brightness = sum(int(part) for part in ground[4:-1].split(",")[:3]) / 3
    assert (brightness > 200) == (scheme == "light"), ground
    keep(browser, f"{page}-{scheme}")


def test_the_button_changes_the_scheme(page, browser):
    """From the scheme of the system to the other one, to the same for good, and back."""
    ground = "getComputedStyle(document.querySelector('main')).backgroundColor"
    before, after = browser.value(ground), []
    for _ in range(3):
        browser.value("document.querySelector('.scheme').click()")
        after.append(browser.value(ground))
    assert after[0] != before and after[1:] == [before, before]
    # the browser remembers the choice for the next page
    assert browser.value("document.querySelector('.scheme').textContent").endswith("auto")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nobody_is_kept_out(page, browser, scheme):
    """axe-core finds nothing serious."""
    axe = os.environ.get("EXCAVATOR_AXE")
    if not axe:
        pytest.skip("EXCAVATOR_AXE does not say where axe-core is (npm install axe-core)")
    browser.screen(*WIDE, scheme)
    browser.value((Path(axe) / "axe.min.js").read_text() + "; true")
    found = browser.value("axe.run().then((found) => found.violations.map((one) => [one.impact, one.id, one.nodes[0].html, one.nodes.length]))")
    assert [one for one in found if one[0] in ("serious", "critical")] == []


def test_a_phone_shows_the_whole_width(page, browser):
    browser.screen(*PHONE)
    browser.wait_for("document.documentElement.scrollWidth <= innerWidth", "the page to be as narrow as the phone")
    keep(browser, f"{page}-phone")


def test_printing_is_light(page, browser):
    browser.screen(*WIDE, "dark")
    printed = base64.b64decode(browser.print_to_pdf())
    assert printed.startswith(b"%PDF") and len(printed) > 10_000
    folder = os.environ.get("EXCAVATOR_PICTURES")
    if folder:
        (Path(folder) / f"{page}.pdf").write_bytes(printed)


def test_plots_obey_the_keyboard(page, browser):
    if not browser.value("document.querySelectorAll('.time-plot').length"):
        pytest.skip("no plot over time on this page")
    browser.value("document.querySelector('.time-plot').focus()")
    browser.press("ArrowRight")
    first = browser.value("document.querySelector('.spoken').textContent")
    browser.press("ArrowRight")
    second = browser.value("document.querySelector('.spoken').textContent")
    assert " s: " in first and second != first
    ticks = "document.querySelector('.time-plot .u-over').parentElement.querySelector('canvas').toDataURL()"
    whole = browser.value(ticks)
    browser.press("+")
    browser.wait_for(f"{ticks} !== {whole!r}", "the plot to zoom in")
