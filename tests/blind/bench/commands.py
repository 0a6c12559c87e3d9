"""Writes beside each case how the program is told of it: the options of `excavator model new` and a map of the columns.

    python commands.py cases

An engineer reads both off the data sheet (machine.json) and the headings of the tables; nothing is taken from the answers.
"""

import json
import math
import sys
from pathlib import Path

GRAVITY = 9.81


def signal(name, column, unit, offset=None, scale=None):
    """One signal of a map, as TOML."""
    lines = ["", "[[signals]]", f'signal = "{name}"', f"column = {json.dumps(column)}", f'unit = "{unit}"']
    if scale is not None:
        lines.append(f"scale = {scale}")
    if offset:
        lines.append(f'offset = "{offset}"')
    return "\n".join(lines) + "\n"


def clock(column, unit):
    """The column with the time, as TOML."""
    return f'[clock]\ncolumn = {json.dumps(column)}\nunit = "{unit}"\n'


def cylinder(sheet, drive="valve", slope=None):
    """Options for a cylinder with a mass."""
    volumes = [
        round(sheet[f"dead_volume_{side}_cm3"] + sheet[f"hose_volume_{side}_cm3"], 2) for side in ("cap", "rod")
    ]
    options = ["--drive", drive]
    options += ["--cylinder", f"{sheet['bore_mm']}/{sheet['rod_mm']} x {sheet['stroke_mm']}"]
    options += ["--mass", f"{sheet['nominal_load_mass_kg']} kg"]
    options += ["--dead-volume", f"{volumes[0]} cm3, {volumes[1]} cm3"]
    options += ["--bulk-modulus", f"{sheet['nominal_bulk_modulus_bar']} bar"]
    return options + (["--slope", str(slope)] if slope else [])


def valve(sheet):
    """Options for a valve on constant pressure."""
    options = ["--supply", f"{sheet['supply_pressure_bar']} bar"]
    options += ["--command", f"{sheet['valve_full_command']} {sheet['valve_command_unit']}"]
    options += ["--rated-flow", f"{sheet['valve_rated_flow_l_min']} l/min"]
    return options + ["--rated-drop", f"{sheet['valve_rated_drop_per_edge_bar']} bar"]


def piston(sheet, time, position, pressures, unit, command):
    """Map of a bench with a valve; columns are (heading, unit)."""
    half = sheet["stroke_mm"] / 2
    text = clock(*time) if time else ""
    text += signal("load.displacement", *position, offset=f"-{half:.0f} mm")
    text += signal("load.cap_pressure", pressures[0], unit) + signal("load.rod_pressure", pressures[1], unit)
    return text + signal("load.orifice_area", *command)


def servo_case(sheet, slope, columns):
    return cylinder(sheet, slope=slope) + valve(sheet), piston(sheet, *columns)


def pump_case(sheet, double_rod, time, position, pressures, speed):
    """The pump's flow without losses is its speed times its displacement."""
    flow = sheet["pump_displacement_cm3_rev"] * sheet["pump_speed_max_rpm"] / 1000
    options = cylinder(sheet, "pump") + ["--supply", f"{sheet['charge_pressure_bar']} bar"]
    options += ["--pump-flow", f"{flow} l/min"] + (["--double-rod"] if double_rod else [])
    volume = sheet["pump_displacement_cm3_rev"] * 1e-6 / (2 * math.pi)
    text = clock(time, "s") + signal("load.displacement", position, "mm", offset=f"-{sheet['stroke_mm'] / 2:.0f} mm")
    text += signal("load.cap_pressure", pressures[0], "bar") + signal("load.rod_pressure", pressures[1], "bar")
    return options, text + signal("load.orifice_area", speed, "rpm", scale=f"{volume:.10e}")


def motor_case(sheet, time, angle, speed, pressures, unit, command):
    """Angle and speed are measured behind the gear; a motor's velocity is that of its shaft."""
    options = ["--drive", "valve", "--motor", f"{sheet['motor_displacement_cm3_rev']} cm3"]
    options += ["--gear", str(sheet["gear_ratio"]), "--inertia", f"{sheet['nominal_inertia_kg_m2']} kg m2"]
    options += ["--dead-volume", f"{sheet['line_volume_a_cm3']} cm3, {sheet['line_volume_b_cm3']} cm3"]
    options += ["--bulk-modulus", f"{sheet['nominal_bulk_modulus_bar']} bar"] + valve(sheet)
    if "hanging_mass_kg" in sheet:
        options += ["--torque", f"{sheet['hanging_mass_kg'] * GRAVITY * sheet['drum_radius_m']:.1f} N m"]
    text = clock(*time) + signal("load.joint_angle", angle, "deg")
    text += signal("load.velocity", speed, "rpm", scale=sheet["gear_ratio"])
    text += signal("load.cap_pressure", pressures[0], unit) + signal("load.rod_pressure", pressures[1], unit)
    return options, text + signal("load.orifice_area", command, "V")


def load_sensing_case(sheet):
    options = cylinder(sheet, "load-sensing", 90) + ["--supply", f"{sheet['pump_pressure_max_bar']} bar"]
    options += ["--pump-flow", f"{sheet['pump_flow_max_l_min']} l/min", "--command", "100 %"]
    options += ["--rated-flow", f"{sheet['valve_rated_flow_cap_l_min']} l/min"]
    options += ["--rated-drop", f"{sheet['valve_rated_drop_per_edge_bar']} bar"]
    options += ["--margin", f"{sheet['load_sensing_margin_bar']} bar", "--metering-drop", f"{sheet['metering_drop_bar']} bar"]
    columns = (("time_s", "s"), ("cylinder_mm", "mm"), ("cap_bar", "rod_bar"), "bar", ("command_pct", "%"))
    return options, piston(sheet, *columns) + signal("pump_pressure", "pump_bar", "bar")


def commands(case, sheet):
    """Options and map of one case."""
    if case == "01":
        pressures = ("Pressure A [bar]", "Pressure B [bar]")
        columns = (("Time [s]", "s"), ("Position [mm]", "mm"), pressures, "bar", ("Valve command [V]", "V"))
        return servo_case(sheet, None, columns)
    if case == "02":
        columns = (("t_s", "s"), ("x_mm", "mm"), ("pA_bar", "pB_bar"), "bar", ("u_V", "V"))
        return servo_case(sheet, None, columns)
    if case == "03":
        columns = (("time (ms)", "ms"), ("stroke (mm)", "mm"), ("p_cap (bar)", "p_rod (bar)"), "bar", ("u (V)", "V"))
        options, text = servo_case(sheet, 90, columns)
        return options, text + signal("pump_pressure", "p_supply (bar)", "bar")
    if case == "04":
        pressures = ("Cap pressure [bar]", "Rod pressure [bar]")
        columns = (("Time [s]", "s"), ("Piston position [mm]", "mm"), pressures, "bar", ("Valve signal [V]", "V"))
        return servo_case(sheet, None, columns)
    if case == "05":
        return pump_case(sheet, True, "time", "position", ("pressure_a", "pressure_b"), "pump_speed")
    if case == "06":
        return pump_case(sheet, False, "Time/s", "Position/mm", ("p_A/bar", "p_B/bar"), "n_pump/rpm")
    if case == "07":
        pressures = ("pA [MPa]", "pB [MPa]")
        return motor_case(sheet, ("t [s]", "s"), "Angle [deg]", "Speed [rpm]", pressures, "MPa", "Command [V]")
    if case == "08":
        pressures = ("P_A(bar)", "P_B(bar)")
        return motor_case(sheet, ("TIME(ms)", "ms"), "DRUM_ANGLE(deg)", "DRUM_SPEED(rpm)", pressures, "bar", "U(V)")
    if case == "09":
        return load_sensing_case(sheet)
    columns = (None, ("position [m]", "m"), ("p1 [kPa]", "p2 [kPa]"), "kPa", ("valve current [mA]", "mA"))
    return servo_case(sheet, None, columns)


def main():
    for folder in sorted(Path(sys.argv[1]).iterdir()):
        sheet = json.loads((folder / "machine.json").read_text())
        options, text = commands(folder.name, sheet)
        (folder / "model-new.args").write_text("\n".join(options) + "\n")
        (folder / "map.toml").write_text(text.lstrip())


if __name__ == "__main__":
    main()
