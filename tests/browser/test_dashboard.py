"""The dashboard in a real browser, on a simulated machine at 1 kHz whose model misses half of its damping.

Seconds by default; EXCAVATOR_LONG=1 watches for about a minute. EXCAVATOR_PICTURES=FOLDER keeps a picture of the page.
"""

import os
import random
import re
import signal
import socket
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest
from browser import LONGEST_WAIT, Browser
from pages import photograph

REPOSITORY = Path(__file__).resolve().parents[2]
LONG = bool(os.environ.get("EXCAVATOR_LONG"))
# Frames of the page that are watched, and those that fill the plots before it.
WATCHED, FILLING = (1500, 800) if LONG else (250, 100)
PROFILE = """
[[profiles]]
cylinder = "arm"
[[profiles.segments]]
kind = "sine"
duration = 20.0
amplitude = 6e-5
frequency = 0.5
"""


@pytest.fixture
def machine(excavator, tmp_path):
    """Simulator, energy monitor, dashboard and commands; address of the page and the processes by name."""
    (tmp_path / "profile.toml").write_text(PROFILE)
    motion = tmp_path / "motion"
    words = ["simulate", "--model", "zx30u-arm", "--input", tmp_path / "profile.toml", "-o", motion]
    subprocess.run([excavator, *words], check=True, capture_output=True)
    nominal = (REPOSITORY / "config" / "zx30u-arm.toml").read_text()
    assert "value = 13000.0" in nominal
    (tmp_path / "stiff.toml").write_text(nominal.replace("value = 13000.0", "value = 26000.0"))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    environment = dict(os.environ, ROS_DOMAIN_ID=str(random.randrange(100, 200)))
    processes = {}

    def start(name, *command):
        log = (tmp_path / f"{name}.log").open("w")
        processes[name] = subprocess.Popen(
            [excavator, *command], env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT
        )

    try:
        start("simulator", "node", "arm-simulator", "--ros-args", "-p", f"model:={tmp_path / 'stiff.toml'}")
        start("monitor", "node", "energy-monitor", "--ros-args", "-p", "model:=zx30u-arm")
        start("dashboard", "dashboard", "--port", str(port))
        start("player", "play", motion, "--topics", "/arm/orifice_command", "--loop", "--delay", "3")
        yield f"http://127.0.0.1:{port}/", processes
        ended = [name for name, process in processes.items() if process.poll() not in (None, 0)]
        assert not ended, {name: (tmp_path / f"{name}.log").read_text()[-500:] for name in ended}
    finally:
        for process in reversed(processes.values()):
            process.send_signal(signal.SIGINT)
        for process in processes.values():
            try:
                process.wait(LONGEST_WAIT)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def memory(process):
    """Resident memory, MB."""
    lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS:")).split()[1]) / 1024


def wait_for_page(address):
    end = time.monotonic() + LONGEST_WAIT
    while True:
        try:
            with urllib.request.urlopen(address, timeout=2) as reply:
                return reply.read().decode()
        except OSError:
            assert time.monotonic() < end, "the page is not served"
            time.sleep(0.1)


def wait_for_frames(browser, more):
    """Until the page has drawn so many more frames."""
    drawn = browser.value("dashboard.frames()")
    browser.wait_for(f"dashboard.frames() >= {drawn + more}", f"{more} frames")


def text(browser, name):
    return browser.value(f"document.getElementById('{name}').textContent")


def check_machine(browser):
    """The arm moves in the picture, the stroke is known, and the page says who commands the valve."""
    browser.wait_for("document.querySelector('#picture .link.chosen') !== null", "the picture of the arm")
    points = "document.querySelector('#picture .link.chosen').getAttribute('points')"
    before = browser.value(points)
    browser.wait_for(f"{points} !== {before!r}", "a motion in the picture")
    assert browser.value("document.querySelector('#picture .link.assumed') === null"), "the joint angle is measured"
    browser.wait_for("document.getElementById('joints').textContent.startsWith('Joint arm: ')", "the joint angle")
    assert "300 mm" in text(browser, "stroke")
    browser.wait_for("document.getElementById('state').className === 'commanded'", "the state of the machine")
    # The player's writer is on no list of its node, so it has a number for a name.
    assert "commanded by " in text(browser, "valve-owner"), text(browser, "valve-owner")
    assert "commanded by" in text(browser, "valves-box") and "priority" in text(browser, "valves")


def check_alarms(browser):
    """Each alarm has the time at which it came first."""
    browser.wait_for("document.querySelectorAll('.alarm').length > 0", "an alarm")
    when = browser.value("document.querySelector('.alarm .when').textContent")
    assert re.match(r"(before )?\d\d:\d\d:\d\d (warning|error), (active|cleared after)", when), when


def check_colours_and_sizes(browser):
    """The scheme of the system decides about colours, the button overrules it, and no size scrolls sideways."""
    ground = "getComputedStyle(document.body).backgroundColor"
    seen = {}
    for scheme in ("dark", "light"):
        for width, height in ((390, 844), (1280, 800), (1920, 1080)):
            browser.screen(width, height, scheme)
            browser.wait_for(f"innerWidth === {width} && dashboard.theme() === '{scheme}'", f"{width} px, {scheme}")
            wide = browser.value("document.documentElement.scrollWidth")
            assert wide <= width, f"the page is {wide} px wide on {width} px"
        seen[scheme] = browser.value(ground)
    assert seen["dark"] != seen["light"], seen
    browser.value("document.getElementById('theme').click()")
    assert browser.value("dashboard.theme()") == "dark" and browser.value(ground) == seen["dark"]
    browser.value("document.getElementById('theme').click()")
    browser.screen(1400, 1000)


@pytest.mark.full
def test_plots_move_alarms_show_and_nothing_grows(machine, chromium, pictures, tmp_path):
    address, processes = machine
    page = wait_for_page(address)
    assert "https://" not in page.replace("https://github.com/leeoniya/uPlot", ""), "the page asks the network for something"
    # a page that never reads what it is sent must not make the server grow
    host, port = address.removeprefix("http://").rstrip("/").split(":")
    sleeper = socket.create_connection((host, int(port)))
    sleeper.sendall(f"GET /stream HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
    with sleeper, Browser(chromium, tmp_path / "browser") as browser:
        browser.open(address)
        browser.wait_for("window.dashboard && dashboard.points() > 50", "the first two seconds of plots")
        says = "document.getElementById('alarms').textContent.includes('does not explain')"
        browser.wait_for(says, "the alarm of the energy monitor")
        check_machine(browser)
        check_alarms(browser)
        check_colours_and_sizes(browser)

        # full plots, so that only what leaks still grows; then the time that is watched
        wait_for_frames(browser, FILLING)
        before = browser.value("dashboard.last()")
        heap, server = browser.heap(), memory(processes["dashboard"])
        wait_for_frames(browser, WATCHED)
        after = browser.value("dashboard.last()")
        heap_after, server_after = browser.heap(), memory(processes["dashboard"])
        told = browser.value("document.getElementById('rate').textContent")
        print(f"heap {heap / 1e6:.2f} -> {heap_after / 1e6:.2f} MB, server {server:.1f} -> {server_after:.1f} MB; {told}")
        if pictures:
            photograph(browser, pictures / "dashboard.png", whole=False)

        for one, other in zip(before, after, strict=True):
            assert all(value is not None for value in other), after
            assert one[1] != other[1], "a plot stands still"
        assert browser.value("dashboard.points()") <= 750
        assert browser.value("document.querySelectorAll('#flow .row').length") >= 3
        assert browser.value("document.querySelectorAll('#terms .row').length") >= 3
        # The page is sent what changed, and not each of the thousand states of a second.
        frames, states = browser.value("[dashboard.frames(), parseInt(document.getElementById('rate').textContent)]")
        assert frames > FILLING + WATCHED and states > 0, (frames, states)
        # in the short test plots and the history of the server are still filling
        assert heap_after - heap < 2e6, "the page grows"
        assert server_after - server < 6, "the server grows"

        # the machine falls silent
        processes["simulator"].send_signal(signal.SIGINT)
        processes["simulator"].wait(LONGEST_WAIT)
        browser.wait_for("document.getElementById('alarms').textContent.includes('no states')", "the alarm of silence")
        browser.wait_for("document.getElementById('state-word').textContent === 'NO DATA'", "old values that look old")
        assert browser.errors == []
