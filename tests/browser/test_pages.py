"""The pages that the program writes, in a real browser: light and dark, printed, by keyboard, without a mouse.

EXCAVATOR_PICTURES=FOLDER keeps pictures of all pages.
"""

import base64
import re
import subprocess

import pytest
from pages import PAGES, PHONE, WIDE, photograph

MOST_BYTES = 1_000_000


def test_every_verb_that_writes_a_page_is_here(excavator):
    """The list of pages is ours, the list of verbs the program's: a verb that learns to write a page is missed at once."""
    text = subprocess.run([excavator, "manual", "verbs"], capture_output=True, text=True, check=True).stdout
    sections = re.split(r"^## excavator ", text, flags=re.MULTILINE)[1:]
    writers = {section.split()[0] for section in sections if "`--report " in section}
    assert len(writers) >= 6
    assert writers == {words[0] for words in PAGES.values()}


def test_pages_are_small_and_need_nothing_else(page, pages):
    text = (pages / f"{page}.html").read_text()
    assert len(text.encode()) < MOST_BYTES
    assert "<link" not in text and "src=" not in text


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_page_follows_the_scheme_of_the_system(page, browser, pictures, scheme):
    browser.screen(*WIDE, scheme)
    ground = browser.value("getComputedStyle(document.querySelector('main')).backgroundColor")
    brightness = sum(int(part) for part in ground[4:-1].split(",")[:3]) / 3
    assert (brightness > 200) == (scheme == "light"), ground
    if pictures:
        photograph(browser, pictures / f"{page}-{scheme}.png")
        browser.screen(*PHONE, scheme)
        photograph(browser, pictures / f"{page}-phone-{scheme}.png")


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


def test_printing_is_light(page, browser, pictures):
    browser.screen(*WIDE, "dark")
    printed = base64.b64decode(browser.print_to_pdf())
    assert printed.startswith(b"%PDF") and len(printed) > 10_000
    if pictures:
        (pictures / f"{page}.pdf").write_bytes(printed)


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
