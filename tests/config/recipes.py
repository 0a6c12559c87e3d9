"""Commands that show what each verb prints: one that works, more where a verb has several faces, and one that fails."""

import re
import shutil
import subprocess
from dataclasses import dataclass
from math import sin
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SAMPLES = REPOSITORY / "bags" / "samples"


@dataclass
class Recipe:
    """Commands of one verb, without their first word."""

    works: list
    fails: list
    # Why what it prints is no text for people, and is printed as it is.
    data: str = ""
    # Why there is no command that comes next.
    last: str = ""


MODEL = ["--model", "zx30u-arm"]
BAG = "validation"
# Enough to find the hidden law in half a minute.
SHORT = ["--identification", "validation@..5", "--validation", "validation@5..10"]
BENCH = [
    "model", "new", "--drive", "valve", "--cylinder", "16/10 x 100", "--mass", "5.5 kg", "--command", "5 V", "--rated-flow", "4 l/min",
    "--supply", "70 bar", "--dead-volume", "15.3 cm3, 16 cm3", "-o",
]  # fmt: skip
VALVE = ["model", "valve", "--model", "bench.toml", "--table", "valve.csv", "--input", "U", "--flow", "Q", "--drop"]

# Live verbs: they need a network, and run until they are stopped. tests/rclpy and tests/browser have what they say.
LIVE = {
    "record": "records live topics",
    "play": "plays to live topics",
    "up": "starts nodes",
    "dashboard": "serves a page of live topics",
    "node arm-simulator": "a node",
    "node arm-bridge": "a node",
    "node joint-controller": "a node",
    "node energy-monitor": "a node",
    "node identification": "a node",
}

OFFLINE = {
    "demo": Recipe(works=[["demo"]], fails=["demo", "-o", "table.csv/demo"]),
    "simulate": Recipe(
        works=[["simulate", *MODEL, "--input", "profile.toml", "-o", "simulated"]],
        fails=["simulate", *MODEL, "--input", "nowhere.toml", "-o", "simulated-2"],
    ),
    "start": Recipe(
        works=[["start", "valve.csv", "--sheet", "valve-sheet.toml"]],
        fails=["start", "valve.csv", "--sheet", "nowhere.toml"],
        last="a static test without a model ends with its numbers",
    ),
    "identify": Recipe(
        works=[["identify", *MODEL, "--bag", BAG], ["identify", "--verbose", *MODEL, "--bag", BAG, "-o", "identified.toml"]],
        fails=["identify", *MODEL, "--bag", "nowhere"],
    ),
    "compare": Recipe(
        works=[
            ["compare", *MODEL, "--bag", BAG],
            ["compare", "--verbose", *MODEL, "--bag", BAG, "--repeat", "identification", "--against", "zx30u-arm"],
        ],
        fails=["compare", "--model", "zx30u-amr", "--bag", BAG],
    ),
    "characterise": Recipe(
        works=[["characterise", *MODEL, BAG]],
        fails=["characterise", *MODEL, "nowhere"],
    ),
    "energy": Recipe(works=[["energy", *MODEL, "--bag", BAG]], fails=["energy", "--model", "emps", "--bag", BAG]),
    "diagnose": Recipe(
        works=[["diagnose", *MODEL, *SHORT, "--save", "study.json"], ["diagnose", "--verbose", *MODEL, *SHORT]],
        fails=["diagnose", *MODEL, "--identification", "nowhere", "--validation", BAG],
    ),
    "changed": Recipe(
        works=[["changed", *MODEL, "--before", BAG, "--after", "identification"]],
        fails=["changed", *MODEL, "--before", BAG, "--after", "nowhere"],
    ),
    "report": Recipe(works=[["report", "study.json"]], fails=["report", "law.toml"]),
    "propose": Recipe(works=[["propose", *MODEL, *SHORT]], fails=["propose", *MODEL, "--identification", BAG, "--validation", "nowhere"]),
    "design": Recipe(
        works=[["design", *MODEL, "--parameter", "arm.inertia", "--duration", "20", "-o", "profile-1.toml"]],
        fails=["design", *MODEL, "--between", "valve_dead_zone,hysteresis", "-o", "profile-2.toml"],
    ),
    "refine": Recipe(
        works=[["refine", "--add", "stribeck_friction@arm", "hose_loss@arm", *MODEL, *SHORT, "-o", "refined.toml"]],
        fails=["refine", "--add", "hose_los", *MODEL, *SHORT, "-o", "refined-2.toml"],
    ),
    "effects": Recipe(
        works=[["effects"], ["effects", "valve_dead_zone"], ["effects", "--language"], ["effects", "--check", "law.toml"]],
        fails=["effects", "valve_dead_zonee"],
        last="a list to look things up in",
    ),
    "model new": Recipe(
        works=[[*BENCH, "bench-1.toml"]],
        fails=["model", "new", "--drive", "valve", "--cylinder", "16/10", "-o", "bench-2.toml"],
    ),
    "model check": Recipe(
        works=[["model", "check", "zx30u-arm"], ["model", "check", "bench.toml"]],
        fails=["model", "check", "nowhere.toml"],
        last="the next command needs a recording, and none is named here",
    ),
    "model valve": Recipe(works=[[*VALVE, "35 bar", "-o", "tested.toml"]], fails=[*VALVE, "35", "-o", "tested-2.toml"]),
    "model position": Recipe(
        works=[["model", "position", "--identification", "position.csv"]],
        fails=["model", "position", "--identification", "table.csv"],
        last="a loop without pressures is no model of a machine",
    ),
    "model urdf": Recipe(works=[["model", "urdf", *MODEL]], fails=["model", "urdf", "--model", "nowhere.toml"], data="XML"),
    "model schema": Recipe(works=[["model", "schema"]], fails=["model", "schema", "--catalogue", "nowhere"], data="JSON"),
    "model reference": Recipe(works=[["model", "reference"]], fails=["model", "reference", "--catalogue", "nowhere"], data="Markdown"),
    "info": Recipe(works=[["info", BAG], ["info", "table.csv"], ["info", "table.csv", "--map", "map.toml"]], fails=["info", "nowhere"]),
    "view": Recipe(
        works=[["view", BAG, "identification", "--report", "view.html"]],
        fails=["view", BAG, "--signal", "arm.cap_presure", "--report", "view-2.html"],
    ),
    "import": Recipe(
        works=[["import", "mapped.csv", "--map", "map.toml", "-o", "imported"]],
        fails=["import", "table.csv", "-o", "imported-2"],
    ),
    "reindex": Recipe(works=[["reindex", "damaged"]], fails=["reindex", "nowhere"]),
    "completions": Recipe(works=[["completions", "bash"]], fails=["completions", "tcsh"], data="a script"),
}


def valve_test():
    """The table of a flow bench: the input of a valve up and down, and the flow through one edge."""
    rows = [f"{volts / 10:.1f};{0.8 * (volts / 10 - 0.2 * (volts > 0) + 0.2 * (volts < 0)):.3f}" for volts in range(-50, 51)]
    return "\n".join(["U [V];Q [l/min]", *rows, *reversed(rows)]) + "\n"


def position_test():
    """The table of a position loop: a reference and a position that follows it after 50 ms."""
    times = [row / 200 for row in range(2000)]
    motion = [(10 * sin(3 * t), 10 * sin(3 * (t - 0.05))) for t in times]
    return "\n".join(["t [s];reference [mm];position [mm]", *(f"{t:.3f};{a:.4f};{b:.4f}" for t, (a, b) in zip(times, motion, strict=True))]) + "\n"


def prepare(excavator, folder):
    """The files that the recipes name, under short names: a path cannot be broken."""
    for name in ("identification", "validation"):
        (folder / name).symlink_to(SAMPLES / "hidden-law" / name)
    shutil.copy(SAMPLES / "profile.toml", folder / "profile.toml")
    shutil.copy(SAMPLES / "arm-swing.csv", folder / "table.csv")
    shutil.copy(SAMPLES / "arm-swing.csv", folder / "mapped.csv")
    shutil.copy(SAMPLES / "arm-swing.csv.map.toml", folder / "map.toml")
    shutil.copytree(SAMPLES / "arm-swing", folder / "damaged")
    (folder / "damaged" / "metadata.yaml").unlink()
    (folder / "valve.csv").write_text(valve_test())
    (folder / "position.csv").write_text(position_test())
    (folder / "valve-sheet.toml").write_text('drop = "35 bar"\n')
    (folder / "law.toml").write_text(
        '[[formula]]\nname = "load_damping"\nacts_on = "piston_force"\nformula = "-k*v*abs(p_cap - p_rod)"\n'
        'parameters.k = { unit = "N s/(m Pa)", maximum = 1.0, start = [1e-3] }\n'
    )
    subprocess.run([excavator, *BENCH, "bench.toml"], cwd=folder, check=True, capture_output=True)


def verbs(excavator, *under):
    """Names of all verbs, as the program lists them; those of a group have two words."""
    text = subprocess.run([excavator, *under, "--help"], capture_output=True, text=True, check=True).stdout
    listed = re.search(r"^Commands:\n(.*?)\n\n", text, flags=re.MULTILINE | re.DOTALL)
    if not listed:
        return [" ".join(under)]
    names = re.findall(r"^  ([a-z]\S*)", listed.group(1), flags=re.MULTILINE)
    return [verb for name in names if name != "help" for verb in verbs(excavator, *under, name)]
