"""Laws of single hydraulic and mechanical elements. SI units, pressures in Pa above tank pressure."""

from math import expm1, sqrt

TRANSITION_PA = 2.0e4
"""Pressure drop [Pa] below which an orifice is laminar rather than turbulent."""


def orifice_root(drop):
    """Signed root of a pressure drop [Pa] in sqrt(Pa), linear near zero: dp / (dp^2 + transition^2)^(1/4)."""
    return drop / sqrt(sqrt(drop * drop + TRANSITION_PA * TRANSITION_PA))


def check_valve_flow(gain, drop):
    """Flow [m3/s] of a check valve with gain [m3/(s sqrt(Pa))]; none when the drop [Pa] is negative."""
    return gain * orifice_root(drop) if drop > 0.0 else 0.0


def flow_energy(pressure, bulk_modulus):
    """Energy [J/m3] that oil at `pressure` carries through a port: beta (exp(p/beta) - 1).

    With dp/dt = beta/V (Q - dV/dt) and the stored energy V (h - p), dH/dt is exactly h Q - p dV/dt.
    """
    return bulk_modulus * expm1(pressure / bulk_modulus)


def smooth_step(value):
    """Rises from 0 to 1 between 0 and 1 with zero slope at both ends."""
    if value <= 0.0:
        return 0.0
    if value >= 1.0:
        return 1.0
    return value * value * (3.0 - 2.0 * value)


def dead_zone(command, negative, positive):
    """Opening behind an overlap: nothing within [-negative, positive], slope one outside."""
    if command > positive:
        return command - positive
    if command < -negative:
        return command + negative
    return 0.0


def play(commands, half_width, start=0.0):
    """Output of a mechanical play: it keeps its value while the command moves within +-half_width of it."""
    output, value = [], start
    for command in commands:
        value = min(max(value, command - half_width), command + half_width)
        output.append(value)
    return output
