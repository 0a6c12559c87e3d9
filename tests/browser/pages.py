"""The pages that the program writes, from recordings of the repository and simulated ones: for tests and for pictures."""

import base64
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SAMPLES = REPOSITORY / "bags" / "samples"
LAW = SAMPLES / "hidden-law"
SEAL = SAMPLES / "seal-friction"
PROFILES = REPOSITORY / "config" / "profiles"
# Short names in the folder of the pages, for pages show them.
BOTH = ["--identification", "identification", "--validation", "validation"]
# Ten seconds show the hidden law, and a search through them takes half a minute and not four.
PARTS = ["--identification", "validation@..5", "--validation", "validation@5..10"]
SEALS = [
    "--identification", "O-ring_1bar.csv", "O-ring_5bar.csv",
    "--validation", "O-ring_3bar.csv", "O-ring_7bar.csv", "--map", "map.toml",
]  # fmt: skip
CAMPAIGN = ["trapezoids", "closed-valve", "sine-0.50", "sine-0.27"]

# Every page by its name: the command that writes it.
PAGES = {
    "refinement": ["refine", "--model", "zx30u-arm", *BOTH, "--add", "stribeck_friction@arm", "-o", "refined.toml"],
    "seal": ["refine", "--model", "rig.toml", *SEALS, "--auto", "-o", "better.toml"],
    "comparison": ["compare", "--model", "zx30u-arm", "--bag", "validation", "--repeat", "identification"],
    "two-models": ["compare", "--model", "zx30u-arm", "--against", "refined.toml", "--bag", "validation"],
    "energy": ["energy", "--model", "zx30u-arm", "--bag", "validation"],
    "changed": ["changed", "--model", "zx30u-arm", "--before", "identification", "--after", "validation"],
    "view": ["view", "identification", "validation", "--from-motion"],
    "refusals": ["characterise", "--model", "zx30u-arm", "validation"],
    "characterisation": ["characterise", "--model", "servo-bench", *CAMPAIGN],
    "diagnosis": ["diagnose", "--model", "zx30u-arm", *PARTS, "--save", "study.json"],
    "diagnosis-again": ["report", "study.json"],
    "proposal": ["propose", "--model", "zx30u-arm", *PARTS],
}

# Pages whose command reads what the command of another one wrote.
READS = {"two-models": "refinement", "diagnosis-again": "diagnosis"}

# Windows of a desk and of a phone, px.
WIDE, PHONE = (1280, 900), (390, 844)
# A page is complete, and its plots are drawn.
READY = "document.readyState === 'complete' && (!document.querySelector('.time-plot') || !!document.querySelector('.uplot'))"
# Plots are drawn anew once the window has kept its size for a while.
SETTLED = """
[...document.querySelectorAll('.time-plot')].every((box) =>
  Math.abs(box.querySelector('canvas').getBoundingClientRect().width - box.clientWidth) < 2)
"""

# Changes to the refined servo bench that make it the machine of the table in docs/papers.md.
OVERLAPS = {"dead_zone_positive = { value = 4e-6": 1.2e-5, "dead_zone_negative = { value = 3e-6": 9e-6}
PLAY = """
[[effects]]
effect = "valve_hysteresis"
at = "load"
[effects.parameters]
play_width = { value = 2e-6, unit = "m2" }
"""


def run(excavator, folder, *words):
    """A command of the program that succeeds; what it printed."""
    result = subprocess.run([excavator, *words], cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, f"{' '.join(map(str, words))}: {result.stderr}"
    return result.stdout


def prepare(excavator, folder):
    """What pages are made of: samples, the rig of the seal as the tutorial corrects it, and a campaign on the bench."""
    for sample in (LAW / "identification", LAW / "validation", SEAL / "map.toml", *SEAL.glob("O-ring_*.csv")):
        (folder / sample.name).symlink_to(sample)
    rig = (SEAL / "rig.toml").read_text()
    assert "value = 4.909e-4" in rig
    (folder / "rig.toml").write_text(rig.replace("value = 4.909e-4", "value = 4.941e-4"))
    bench = (REPOSITORY / "config" / "servo-bench-refined.toml").read_text()
    for start, value in OVERLAPS.items():
        assert start in bench, start
        bench = bench.replace(start, f"{start.rsplit(' ', 1)[0]} {value}")
    (folder / "bench.toml").write_text(bench + PLAY)
    for name in CAMPAIGN:
        run(excavator, folder, "simulate", "--model", "bench.toml", "--input", PROFILES / f"bench-{name}.toml", "-o", name)


def write(excavator, folder, name):
    """A page as NAME.html, and before it the one whose model it reads; what is there already stays."""
    if (folder / f"{name}.html").exists():
        return
    if name in READS:
        write(excavator, folder, READS[name])
    run(excavator, folder, *PAGES[name], "--report", f"{name}.html")


def photograph(browser, path, whole=True):
    """A picture of the page; folders that are missing are made."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(base64.b64decode(browser.picture(whole)))
