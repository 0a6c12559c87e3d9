"""The same work with the programs of others: reads an order (JSON) from standard input, prints time and result (JSON).

    python peers.py rosbags|mcap_ros2|lsoda|pysindy < order.json
"""

import json
import math
import sys
import time
import tomllib

REPETITIONS = 3
# Samples that PySINDy smooths over: the best of 11, 25, 51 and 101 here.
WINDOW = 51


def best_of(work, repetitions=REPETITIONS):
    """The shortest time of several runs in s, and the last result."""
    best = math.inf
    for _ in range(repetitions):
        begin = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - begin)
    return best, result


def rosbags(order):
    """Every message of a bag as an object, with the definitions that are in the bag."""
    from pathlib import Path

    from rosbags.highlevel import AnyReader

    def read():
        count = 0
        with AnyReader([Path(order["bag"])]) as reader:
            for connection, _, data in reader.messages():
                reader.deserialize(data, connection.msgtype)
                count += 1
        return count

    seconds, count = best_of(read, 1)
    return seconds, f"{count} messages"


def mcap_ros2(order):
    """Every message of a file as an object, with the definitions that are in the file."""
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    def read():
        with open(order["file"], "rb") as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()])
            return sum(1 for _ in reader.iter_decoded_messages())

    seconds, count = best_of(read, 1)
    return seconds, f"{count} messages"


def right_hand_side(order):
    """The equations of [A] for one arm with the boom held; states q, dq/dt, cap, rod and pump pressure (rad, rad/s, Pa)."""
    machine, value = tomllib.loads(order["model"])["machine"], order["parameters"]
    cylinder, supply = machine["cylinders"][0], machine["supply"]

    def number(entry):
        """Of a quantity with a unit."""
        return entry["value"]

    linkage, chambers = cylinder["linkage"], cylinder["chambers"]
    foot, rod, middle = (number(linkage[name]) for name in ("foot_arm", "rod_arm", "mid_stroke_length"))
    cap_area, rod_area = number(chambers["cap_area"]), number(chambers["rod_area"])
    cap_dead, rod_dead = number(chambers["cap_dead_volume"]), number(chambers["rod_dead_volume"])
    most, half = number(chambers["maximum_orifice_area"]), number(cylinder["stroke"]) / 2
    base, gravity = number(machine["mechanism"]["base_angle"]), number(machine["gravity"])
    line, flow, tank = number(supply["volume"]), number(supply["flow"]), number(supply["tank_pressure"])
    inertia, moment = value["arm.inertia"], value["arm.gravity_moment"]
    damping, friction = value["arm.viscous_damping"], value["arm.coulomb_friction"]
    oil, pump_oil = value["arm.bulk_modulus"], value["pump.bulk_modulus"]
    cap_gain, rod_gain = value["arm.flow_gain_cap"], value["arm.flow_gain_rod"]
    internal, external_cap = value["arm.internal_leakage"], value["arm.external_leakage_cap"]
    external_rod, bypass = value["arm.external_leakage_rod"], value["pump.bypass_flow_gain"]
    vapour, make_up = value["arm.vapour_pressure"], value["arm.make_up_gain"]
    interval, area = order["time"][1] - order["time"][0], order["area"]
    last = len(area) - 2

    def root(drop):
        """Turbulent far from zero, laminar under 2 kPa."""
        return drop / (drop * drop + 4e6) ** 0.25

    def lack(pressure):
        """How far a pressure is below that of vapour, rounded over 100 Pa."""
        missing = vapour - pressure
        return max(missing, 0.0) if abs(missing) >= 100.0 else (missing + 100.0) ** 2 / 400.0

    def rates(now, state):
        q, speed, cap, rod_pressure, pump = state
        index = min(int(now / interval), last)
        share = now / interval - index
        u = area[index] + share * (area[index + 1] - area[index])
        length = math.sqrt(foot * foot + rod * rod - 2 * foot * rod * math.cos(q))
        lever = foot * rod * math.sin(q) / length
        s, v = length - middle, lever * speed
        force = cap_area * cap - rod_area * rod_pressure - damping * v - friction * math.tanh(v / 1e-3)
        torque = lever * force - moment * gravity * math.sin(q + base)
        if u >= 0:
            drawn = cap_gain * u * root(pump - cap)
            into_cap, into_rod = drawn, -rod_gain * u * root(rod_pressure - tank)
        else:
            drawn = -rod_gain * u * root(pump - rod_pressure)
            into_cap, into_rod = cap_gain * u * root(cap - tank), drawn
        into_cap -= internal * (cap - rod_pressure) + external_cap * cap + cap_area * v - make_up * lack(cap)
        into_rod += internal * (cap - rod_pressure) - external_rod * rod_pressure + rod_area * v + make_up * lack(rod_pressure)
        into_line = flow - drawn - bypass * max(most - abs(u), 0.0) * root(pump - tank)
        return (
            speed,
            torque / inertia,
            oil * into_cap / (cap_dead + cap_area * (half + s)),
            oil * into_rod / (rod_dead + rod_area * (half - s)),
            pump_oil * into_line / line,
        )

    return rates


def lsoda(order):
    """SciPy's LSODA at the coarsest tolerance at which it is as exact as asked; rms of the pressures in Pa."""
    import numpy
    from scipy.integrate import solve_ivp

    reference = numpy.array(order["reference"])
    rates, times, start = right_hand_side(order), order["time"], order["start"]

    def solve(tolerance):
        solution = solve_ivp(
            rates, (0.0, times[-1]), start, method="LSODA", t_eval=times, rtol=tolerance,
            atol=[0.01 * tolerance, 0.1 * tolerance] + 3 * [1e6 * tolerance],
        )
        if not solution.success:
            return math.inf
        return float(numpy.sqrt(numpy.mean((solution.y.T[:, 2:] - reference[:, 2:]) ** 2)))

    error = math.inf
    for tolerance in order["tolerances"]:
        seconds, error = best_of(lambda: solve(tolerance), 1)
        if error <= order["error"]:
            return seconds, f"{error:.0f} Pa at {tolerance:.0e}"
    raise LookupError(f"not as exact at any tolerance tried; {error:.0f} Pa at the finest")


def pysindy(order):
    """Bulk modulus and flow gain of the cap side: smoothed differences, then least squares without a threshold."""
    import numpy
    import pysindy as ps

    columns = {name: numpy.array(values) for name, values in order["columns"].items()}
    now, place, cap, pump, tank, area = (columns[name] for name in ("time", "displacement", "cap", "pump", "tank", "area"))
    piston, volume = order["piston_area"], order["volume_at_middle"] + order["piston_area"] * columns["displacement"]

    def root(drop):
        return drop / (drop * drop + 4e6) ** 0.25

    def fit():
        differences = ps.SmoothedFiniteDifference(smoother_kws={"window_length": WINDOW, "polyorder": 3})
        velocity = differences(place.reshape(-1, 1), t=now)[:, 0]
        orifice = area * numpy.where(area >= 0, root(pump - cap), root(cap - tank))
        inputs = numpy.column_stack([-piston * velocity, orifice, -cap]) / volume[:, None]
        model = ps.SINDy(
            optimizer=ps.STLSQ(threshold=0.0, alpha=0.0, normalize_columns=True),
            feature_library=ps.IdentityLibrary(),
            differentiation_method=differences,
        )
        model.fit(cap.reshape(-1, 1), t=now, u=inputs)
        return model.coefficients()[0][1:]

    seconds, coefficients = best_of(fit)
    found = {"bulk modulus": coefficients[0], "flow gain": coefficients[1] / coefficients[0]}
    errors = [f"{name} {100 * (found[name] / true - 1):+.1f} %" for name, true in order["truth"].items()]
    return seconds, ", ".join(errors)


def main():
    order = json.load(sys.stdin)
    try:
        seconds, result = {"rosbags": rosbags, "mcap_ros2": mcap_ros2, "lsoda": lsoda, "pysindy": pysindy}[sys.argv[1]](order)
        answer = {"seconds": seconds, "result": result}
    except (ImportError, LookupError) as reason:
        answer = {"missing": str(reason)}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
