"""Helpers that the definitions share: areas, data sheets, lists of true coefficients."""

from math import pi, sqrt

from case import around, quantity, rounded

BAR = 1.0e5
MM = 1.0e-3
LITRE_PER_MINUTE = 1.0e-3 / 60.0
G = 9.81
RPM = 30.0 / pi
"""rev/min per rad/s."""
DEG = 180.0 / pi


def areas(bore_mm, rod_mm):
    """Cap and rod side areas [m2]."""
    return pi / 4 * (bore_mm * MM) ** 2, pi / 4 * ((bore_mm * MM) ** 2 - (rod_mm * MM) ** 2)


def edge_gain(flow_lpm, drop_bar):
    """Gain [m3/(s sqrt(Pa))] of an edge that passes a flow [l/min] at a drop [bar]."""
    return flow_lpm * LITRE_PER_MINUTE / sqrt(drop_bar * BAR)


def sheet_volumes(rng, dead_a, dead_b, hose_a, hose_b):
    """Dead and hose volumes [cm3] as a data sheet states them, a few per cent from the truth [m3]."""
    return {
        "dead_volume_cap_cm3": rounded(around(rng, dead_a * 1e6, 0.03)),
        "dead_volume_rod_cm3": rounded(around(rng, dead_b * 1e6, 0.03)),
        "hose_volume_cap_cm3": rounded(around(rng, hose_a * 1e6, 0.05)),
        "hose_volume_rod_cm3": rounded(around(rng, hose_b * 1e6, 0.05)),
    }


def base_truth(actuator, gain_a=None, gain_b=None, full=None, command_unit=None):
    """True coefficients of the base model, for the answer."""
    f = actuator.friction
    rotary = actuator.rotary
    base = {
        "inertia" if rotary else "mass": quantity(actuator.mass, "kg m2" if rotary else "kg"),
        "viscous_damping": quantity(f.viscous, "N m s/rad" if rotary else "N s/m"),
        "coulomb_friction": quantity(f.coulomb, "N m" if rotary else "N"),
        "sign_width": quantity(f.width, "rad/s" if rotary else "m/s", "friction acts as tanh(speed / width)"),
        "load_force" if not rotary else "load_torque": quantity(actuator.load, "N m" if rotary else "N"),
        "bulk_modulus": quantity(actuator.bulk_modulus, "Pa"),
        "leak_internal": quantity(actuator.leak_internal, "m3/(s Pa)"),
        "leak_external_each_side": quantity(actuator.leak_external, "m3/(s Pa)"),
        "area_a": quantity(actuator.area_a, "m3/rad" if rotary else "m2"),
        "area_b": quantity(actuator.area_b, "m3/rad" if rotary else "m2"),
        "volume_a_at_zero": quantity(actuator.volume_a, "m3"),
        "volume_b_at_zero": quantity(actuator.volume_b, "m3"),
    }
    if gain_a is not None:
        whole = "m3/(s sqrt(Pa)) at full command"
        unit = f"m3/(s sqrt(Pa)) per {command_unit}"
        base["Cf_cap_full"] = quantity(gain_a, whole)
        base["Cf_rod_full"] = quantity(gain_b, whole)
        base["Cf_cap"] = quantity(gain_a / full, unit)
        base["Cf_rod"] = quantity(gain_b / full, unit)
    if actuator.stops:
        base["stop_low"] = quantity(actuator.stops.low, "m")
        base["stop_high"] = quantity(actuator.stops.high, "m")
        base["stop_stiffness"] = quantity(actuator.stops.stiffness, "N/m^1.5")
    return base


def signals(sensors, meanings, time_heading=None):
    """The list of columns for the data sheet."""
    listed = [{"column": time_heading, "meaning": "time"}] if time_heading else []
    for sensor in sensors:
        entry = {"column": sensor.heading, "meaning": meanings[sensor.source], "unit": sensor.unit}
        if sensor.span:
            entry["range"] = list(sensor.span)
        entry["noise_rms_about"] = rounded(sensor.noise, 2)
        if sensor.bits:
            entry["converter_bits"] = sensor.bits
        listed.append(entry)
    return listed


MEANINGS = {
    "x": "piston position from the retracted end, positive when extending",
    "pa": "pressure on the cap side (A)",
    "pb": "pressure on the rod side (B)",
    "command": "valve command, positive opens P to A and extends",
    "supply": "supply pressure at the valve",
}
