"""The equations of [A] Eq. 6-8 solved by numpy, for printed_least_squares.rs: python3 printed_least_squares.py

Reads sine_of_the_paper.txt: s in nm, p+, p-, pp in 0.1 Pa, u in 1e-12 m2, one sample every 2 ms.
"""
import pathlib

import numpy as np

LA, LB, LC, L, BASE, G = 1.1, 0.33, 1.1, 0.6, 1.0471975511965976, 9.8
A_CAP, A_ROD, V_CAP, V_ROD, V_PUMP = 3.8e-3, 2.6e-3, 3.4e-4, 3.0e-4, 1.2e-4
PUMP_FLOW, LARGEST, TANK, STEP, WIDTH = 3.8e-4, 1.15e-4, 0.0, 2e-3, 43


def noise(count, state):
    """Sums of twelve uniform numbers less six, from a generator that any language has."""
    values = []
    for _ in range(count):
        total = -6.0
        for _ in range(12):
            state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
            total += (state >> 11) / 2**53
        values.append(total)
    return np.array(values), state


def slope(signal):
    """First difference, then a moving average of 43 samples."""
    difference = np.append(np.diff(signal), signal[-1] - signal[-2]) / STEP
    return np.convolve(difference, np.ones(WIDTH) / WIDTH, mode="same")


def solve(matrix, right):
    lengths = np.linalg.norm(matrix, axis=0)
    solution = np.linalg.lstsq(matrix / lengths, right, rcond=None)[0] / lengths
    return solution, np.linalg.cond(matrix), np.linalg.cond(matrix / lengths)


def identify(s, cap, rod, pump, u):
    length = LC + s
    interior = np.arccos((LA**2 + LB**2 - length**2) / (2 * LA * LB))
    q = 2 * np.pi - interior
    lever = -LA * LB * np.sin(interior) / length
    v, acceleration = slope(s), slope(slope(q))
    kept = slice(2 * WIDTH, len(s) - 2 * WIDTH)

    mechanical = np.stack([acceleration, lever * v, lever * np.sign(v), G * np.sin(BASE + q)], axis=1)
    first = solve(mechanical[kept], (lever * (A_CAP * cap - A_ROD * rod))[kept])

    root = lambda x: np.sign(x) * np.sqrt(np.abs(x))
    h_cap = np.where(u > 0, root(pump - cap), root(cap - TANK))
    h_rod = np.where(u > 0, root(rod - TANK), root(pump - rod))
    zero = np.zeros_like(s)
    volume_cap, volume_rod = V_CAP + (L / 2 + s) * A_CAP, V_ROD + (L / 2 - s) * A_ROD
    # Columns: 1/b, 1/bp, Cf+, Cf-, Cft, Ce+, Ce-, Ci. Signs of the pump's row: errata 3 and 4 of physics.md.
    rows = [
        [-volume_cap * slope(cap), zero, h_cap * u, zero, zero, -cap, zero, -(cap - rod)],
        [-volume_rod * slope(rod), zero, zero, -h_rod * u, zero, zero, -rod, cap - rod],
        [zero, V_PUMP * slope(pump), h_cap * np.maximum(u, 0), h_rod * np.maximum(-u, 0),
         root(pump - TANK) * (LARGEST - np.abs(u)), zero, zero, zero],
    ]
    rights = [A_CAP * v, -A_ROD * v, np.full_like(s, PUMP_FLOW)]
    matrix = np.concatenate([np.stack(row, axis=1)[kept] for row in rows])
    second = solve(matrix, np.concatenate([right[kept] for right in rights]))
    return first, second


def main():
    file = pathlib.Path(__file__).with_name("sine_of_the_paper.txt")
    exact = np.loadtxt(file) * np.array([1e-9, 1e-1, 1e-1, 1e-1, 1e-12])
    for level in [0.0, 2e3, 2e4]:
        signals, state = [], 1
        for column, size in zip(exact.T, [0.0 if level == 0.0 else 5e-5, level, level, level, 0.0]):
            values, state = noise(len(column), state)
            signals.append(column + size * values)
        (a1, plain1, scaled1), (a2, plain2, scaled2) = identify(*signals)
        a2[:2] = 1 / a2[:2]
        print(f"pressure noise {level:g} Pa: J2 Fd2 Fc2 W2 | b bp Cf+ Cf- Cft Ce+ Ce- Ci | condition numbers")
        for numbers in [a1, a2, [plain1, scaled1, plain2, scaled2]]:
            print("    " + ", ".join(f"{value:.15e}" for value in numbers))


main()
