#!/usr/bin/env python3
"""Laws that were written without a look at the grammar of `excavator propose`: does it find them?

Each law is simulated on an arm whose parameters are up to 22 % off the nominal ones, with the valve movements of the sample
`hidden-law` and the noise of its instruments. Then `propose` looks for it, and the true form is fitted as well. A law is found
when what comes first, or is tied with it, predicts the validation recording within 10 % of what the true form does.

    .venv/bin/python tests/laws/laws.py [NAME...] [--program target/release/excavator] [--folder FOLDER]

About 50 s for each law on two cores.
"""

import argparse
import json
import pathlib
import re
import subprocess
import tempfile
import time

import numpy as np
from rosbags.highlevel import AnyReader

ROOT = pathlib.Path(__file__).resolve().parents[2]
INPUT = ROOT / "bags/samples/hidden-law"
PARTS = ("identification", "validation")
NEARLY = 1.1

# Row, formula, parameters with value and unit.
LAWS = {
    "damping_by_square_position": ("piston_force", "-k*v*s^2", {"k": (3e6, "N s/m3")}),
    "friction_along_a_ramp": ("piston_force", "-k*sign(v)*max(s - c, 0)", {"k": (8e3, "N/m"), "c": (-0.03, "m")}),
    "leak_that_falls_along_the_stroke": (
        "piston_leak",
        "k*(p_cap - p_rod)*exp(-s/c)",
        {"k": (2e-11, "m3/(s Pa)"), "c": (0.06, "m")},
    ),
    "square_relief": ("cap_flow", "-k*max(p_cap - c, 0)^2", {"k": (4e-17, "m3/(s Pa2)"), "c": (7e5, "Pa")}),
    "opening_by_speed": ("opening", "u*(1 - k*abs(v))", {"k": (1.0, "s/m")}),
    "square_joint_damping": ("joint_torque", "-k*qd*abs(qd)", {"k": (6e3, "N m s2/rad2")}),
    "square_pump_leak": ("pump_leak", "k*p_pump^2", {"k": (1.5e-17, "m3/(s Pa2)")}),
    "open_way_to_tank": ("rod_to_tank", "k*root(p_rod - p_tank)", {"k": (3e-8, "m3/(s Pa^0.5)")}),
    "damping_that_fades": ("piston_force", "-k*v*exp(-t/c)", {"k": (8e3, "N s/m"), "c": (15.0, "s")}),
    "friction_that_saturates": (
        "piston_force",
        "-k*tanh(v/c)*abs(p_cap - p_rod)",
        {"k": (4e-4, "m2"), "c": (0.03, "m/s")},
    ),
    "friction_by_root_of_pressure": ("piston_force", "-k*sqrt(abs(p_cap))*sign(v)", {"k": (0.8, "N/Pa^0.5")}),
    "pump_relief_to_the_1.5": (
        "pump_leak",
        "k*max(p_pump - c, 0)^1.5",
        {"k": (3e-13, "m3/(s Pa^1.5)"), "c": (1e6, "Pa")},
    ),
    "one_way_damping": ("piston_force", "-k*v*abs(v)*step(-v)", {"k": (9e4, "N s2/m2")}),
    "moment_by_sine_of_joint": ("joint_torque", "-k*sin(q)", {"k": (250.0, "N m")}),
    "turbulent_leak_by_position": ("piston_leak", "k*root(p_cap - p_rod)*abs(s)", {"k": (3e-7, "m2/(s Pa^0.5)")}),
    "filter_in_the_return": ("return_opening", "u/sqrt(1 + (u/c)^2)", {"c": (2e-4, "m2")}),
    "square_leak_to_air": ("cap_flow", "-k*p_cap^2", {"k": (1.5e-17, "m3/(s Pa2)")}),
    "opening_by_position": ("opening", "u*(1 - k*s)", {"k": (0.8, "1/m")}),
    "pin_friction": (
        "joint_torque",
        "-k*sign(qd)*abs(area_cap*p_cap - area_rod*p_rod)",
        {"k": (0.02, "m")},
    ),
    "damping_between_two_places": (
        "piston_force",
        "-k*v*step(s - c)*step(d - s)",
        {"k": (1.2e4, "N s/m"), "c": (-0.06, "m"), "d": (0.01, "m")},
    ),
}

NOISE = {
    "displacement": (5e-5, "m"),
    "cap_pressure": (2e3, "Pa"),
    "rod_pressure": (2e3, "Pa"),
    "orifice_area": (2e-7, "m2"),
    "pump_pressure": (2e3, "Pa"),
    "tank_pressure": (2e3, "Pa"),
}


def formula_file(law) -> str:
    row, formula, parameters = law
    lines = ["[[formula]]", 'name = "hidden_law"', f'acts_on = "{row}"', f'formula = "{formula}"', "[formula.parameters]"]
    for name, (value, unit) in parameters.items():
        lowest = -abs(value) * 100 if value < 0 or name in "cd" else 0.0
        lines.append(f'{name} = {{ unit = "{unit}", minimum = {lowest:e}, maximum = {abs(value) * 100:e}, start = [{value:e}] }}')
    return "\n".join(lines) + "\n"


def machine_file(law, rng) -> str:
    """The arm with other parameters and the law."""
    lines, section = [], ""
    for line in (ROOT / "config/zx30u-arm.toml").read_text().splitlines():
        section = line.strip() if line.startswith("[") else section
        parts = re.match(r"(\w+ = \{ value = )([-\d.eE]+)(.*)", line)
        if parts and section == "[effects.parameters]" and "known = true" not in line:
            line = f"{parts[1]}{float(parts[2]) * (1 + rng.uniform(-0.22, 0.22))!r}{parts[3]}"
        lines.append(line)
    place = "pump" if law[0] == "pump_leak" else "arm"
    lines += ["[[effects]]", 'effect = "hidden_law"', f'at = "{place}"', "[effects.parameters]"]
    lines += [f'{name} = {{ value = {value:e}, unit = "{unit}" }}' for name, (value, unit) in law[2].items()]
    return "\n".join(lines) + "\n" + formula_file(law)


def write_table(bag: pathlib.Path, table: pathlib.Path, rng) -> None:
    """A simulated bag as a table with noise, and the map that reads it."""
    with AnyReader([bag]) as reader:
        states = [c for c in reader.connections if c.topic == "/arm/state"]
        messages = [(stamp, reader.deserialize(raw, c.msgtype)) for c, stamp, raw in reader.messages(connections=states)]
    time_s = np.array([stamp - messages[0][0] for stamp, _ in messages]) * 1e-9
    columns = {"t": time_s}
    for name, (size, _) in NOISE.items():
        of = (lambda m: m) if name in ("pump_pressure", "tank_pressure") else (lambda m: m.cylinders[0])
        true = np.array([getattr(of(message), name) for _, message in messages])
        columns[name] = true + rng.normal(0.0, size, len(true))
    np.savetxt(table, np.column_stack(list(columns.values())), delimiter=",", fmt="%.9g", header=",".join(columns), comments="")
    signals = ""
    for name, (_, unit) in NOISE.items():
        signal = name if name in ("pump_pressure", "tank_pressure") else f"arm.{name}"
        signals += f'\n[[signals]]\nsignal = "{signal}"\ncolumn = "{name}"\nunit = "{unit}"\n'
    pathlib.Path(f"{table}.map.toml").write_text('[clock]\ncolumn = "t"\nunit = "s"\n' + signals)


def run(*command) -> None:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stderr}")


def try_law(name, law, program, folder) -> bool:
    rng = np.random.default_rng(sum(name.encode()))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "truth.toml").write_text(machine_file(law, rng))
    (folder / "form.toml").write_text(formula_file(law))
    for part in PARTS:
        run(program, "simulate", "--model", folder / "truth.toml", "--input", INPUT / part, "-o", folder / part, "--force")
        write_table(folder / part, folder / f"{part}.csv", rng)
    recordings = [word for part in PARTS for word in (f"--{part}", folder / f"{part}.csv")]
    model = ("--model", "zx30u-arm", *recordings)
    began = time.monotonic()
    run(program, "propose", *model, "-o", folder / "laws.toml", "--json", folder / "laws.json", "--force")
    seconds = time.monotonic() - began
    place = "pump" if law[0] == "pump_leak" else "arm"
    true_form = ("--catalogue", folder / "form.toml", "--add", f"hidden_law@{place}", "-o", folder / "refined.toml")
    run(program, "refine", *model, *true_form, "--json", folder / "refined.json", "--force")
    found = json.loads((folder / "laws.json").read_text())
    signals = json.loads((folder / "refined.json").read_text())["steps"][-1]["signals"].values()
    truth = float(np.mean([one["nmse"] for one in signals]))
    ahead = [one for number, one in enumerate(found["proposals"]) if number == 0 or one["tied_with_first"]]
    least = min((one["validation_error_after"] for one in ahead), default=float("inf"))
    is_found = found["verdict"] == "law" and least <= NEARLY * truth
    forms = " | ".join(one["formula"] for one in ahead)
    print(f"{'found ' if is_found else 'MISSED'} {name}: {law[0]} {law[1]}", flush=True)
    print(f"       {found['verdict']}, {least / truth:.2f} of the true form's error, {seconds:.0f} s: {forms}", flush=True)
    return is_found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(LAWS)}")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/excavator")
    parser.add_argument("--folder", type=pathlib.Path)
    options = parser.parse_args()
    names = options.names or list(LAWS)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or pathlib.Path(temporary)
        found = [try_law(name, LAWS[name], options.program, folder / name) for name in names]
    print(f"{sum(found)} of {len(found)} found")


if __name__ == "__main__":
    main()
