"""Everybody can read every page: light and dark, on a desk and on a phone, with all that is folded away opened.

axe-core judges the document; EXCAVATOR_AXE is the folder of its npm package, without it that test skips. What axe-core does not
see, text in pictures and on canvases, probe.js looks at.
"""

import pytest
from pages import PHONE, SETTLED, WIDE

# Smallest text, px.
LEAST_TEXT = 11
# Least contrast of text of that size: WCAG 2.2, level AA.
LEAST_CONTRAST = 4.5
# Plots follow the scheme in the frame in which the page learns of it.
TWO_FRAMES = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
FOLDED = "document.querySelectorAll('details:not([open])').length"


@pytest.fixture(params=["light", "dark"])
def scheme(request):
    return request.param


@pytest.fixture(params=[WIDE, PHONE], ids=["desk", "phone"])
def window(request):
    return request.param


@pytest.fixture
def view(page, browser, window, scheme):
    """The page in this window and scheme, with every box opened."""
    browser.screen(*window, scheme)
    browser.wait_for(f"innerWidth === {window[0]}", "the window")
    browser.value("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    browser.wait_for(SETTLED, "plots as wide as their boxes")
    browser.wait_for(f"matchMedia('(prefers-color-scheme: {scheme})').matches", f"the {scheme} scheme")
    browser.value(TWO_FRAMES)
    return browser


def test_nobody_is_kept_out(view, axe):
    """axe-core finds nothing serious."""
    view.value(axe + "; true")
    found = view.value(
        "axe.run().then((found) => found.violations.map("
        "(one) => [one.impact, one.id, one.nodes.length, one.nodes.slice(0, 3).map((node) => node.html)]))"
    )
    assert [one for one in found if one[0] in ("serious", "critical")] == []


def test_folded_boxes_keep_nobody_out(page, browser, scheme, axe):
    """As a page opens, with its boxes folded, axe-core finds nothing serious either."""
    if not browser.value(FOLDED):
        pytest.skip("nothing is folded on this page")
    browser.screen(*PHONE, scheme)
    browser.value(axe + "; true")
    found = browser.value("axe.run().then((found) => found.violations.map((one) => [one.impact, one.id]))")
    assert [one for one in found if one[0] in ("serious", "critical")] == []


def test_the_page_does_not_scroll_sideways(view, window):
    """What is wider than the window scrolls in a box of its own."""
    wide = view.value("Math.max(document.documentElement.scrollWidth, document.body.scrollWidth)")
    assert wide <= window[0]


def test_there_is_text_to_look_at(page, browser):
    """The probe finds text of every kind that a page has; else the tests below could not fail."""
    counts = browser.value("probe.counts()")
    assert counts["document"] > 20
    assert (counts["picture"] > 0) == browser.value("document.querySelectorAll('svg text').length > 0")
    assert (counts["canvas"] > 0) == browser.value("document.querySelectorAll('canvas').length > 0")


def test_text_is_large_enough(view):
    assert view.value(f"probe.smallerThan({LEAST_TEXT})") == []


def test_text_of_pictures_stands_out(view):
    """axe-core sees the text of the document, and not that of pictures."""
    assert view.value(f"probe.fainterThan({LEAST_CONTRAST})") == []


def test_no_text_is_on_another(view):
    """Headings, labels and numbers of axes have places of their own."""
    assert view.value("probe.overlapping()") == []


def test_no_text_is_cut_off(view):
    assert view.value("probe.cutOff()") == []


FAULTS = """
<p style="font-size: 9px">small</p>
<div style="position: absolute; left: 20px; top: 60px">one text</div><div style="position: absolute; left: 30px; top: 62px">on another</div>
<svg width="100" height="20" style="position: absolute; left: 0; top: 120px">
  <text x="5" y="14" font-size="12" fill="#bbbbbb">faint</text></svg>
<svg width="100" height="20" style="position: absolute; left: -15px; top: 160px"><text x="5" y="14" font-size="12">cut</text></svg>
<canvas width="60" height="20" style="position: absolute; left: 0; top: 200px"></canvas>
<script>const paper = document.querySelector("canvas").getContext("2d"); paper.font = "12px sans-serif"; paper.fillText("drawn", 40, 14);</script>
"""


def test_the_probe_finds_what_is_wrong(browser, tmp_path):
    """On a page with one fault of each kind, each is found, and nothing else."""
    (tmp_path / "faults.html").write_text(FAULTS)
    browser.screen(*WIDE)
    browser.open((tmp_path / "faults.html").as_uri())
    browser.wait_for("document.readyState === 'complete' && !!document.querySelector('canvas')", "the page of faults")
    assert browser.value(f"probe.smallerThan({LEAST_TEXT})") == ['9.00 px: p "small"']
    overlapping = browser.value("probe.overlapping()")
    assert len(overlapping) == 1 and 'div "one text" and div "on another"' in overlapping[0], overlapping
    faint = browser.value(f"probe.fainterThan({LEAST_CONTRAST})")
    assert len(faint) == 1 and 'picture "faint"' in faint[0], faint
    assert browser.value("probe.cutOff()") == ['picture "cut"', 'canvas "drawn"']
