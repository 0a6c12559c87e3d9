"""The energy monitor: one balance per state, and what it says follows from the state."""

import math
import tomllib

import pytest
from excavator_msgs.msg import EnergyState
from support.simulator import STATE_QOS, Simulator, all_finite, cylinder, steps

AREA = 5e-5
TIME = 2.0


def key(message):
    return message.header.stamp.sec, message.header.stamp.nanosec


@pytest.fixture(scope="module")
def pairs(ros, excavator):
    """(state, energy) of the same stamp, while the arm moves out and back and no sample is missing."""
    simulator = Simulator(ros, excavator)
    ros.start(excavator, "node", "energy-monitor")
    energies = ros.hear(EnergyState, "/arm/energy", STATE_QOS)

    def out_and_back():
        simulator.settle()
        simulator.hold(0.3, arm=AREA)
        with simulator.holding(arm=AREA):
            out = simulator.watch(TIME / 2)
        with simulator.holding(arm=-AREA):
            return out + simulator.watch(TIME / 2)

    states = simulator.undisturbed(out_and_back)
    wanted = {key(state) for state in states}
    ros.spin_until(lambda: wanted <= {key(energy) for energy in energies}, "one balance per state")
    by_stamp = {key(energy): energy for energy in energies}
    assert len(by_stamp) == len(energies), "two balances for one state"
    return [(state, by_stamp[key(state)]) for state in states]


@pytest.fixture(scope="module")
def parameters(model):
    """Known constants and true parameters of the simulated arm."""
    document = tomllib.loads(model.read_text())
    values = {}
    for effect in document["effects"]:
        values |= {f"{effect['at']}.{name}": entry["value"] for name, entry in effect["parameters"].items()}
    machine = document["machine"]
    values |= {name: entry["value"] for name, entry in machine["cylinders"][0]["chambers"].items()}
    values["stroke"] = machine["cylinders"][0]["stroke"]["value"]
    values["base_angle"] = machine["mechanism"]["base_angle"]["value"]
    values["gravity"] = machine["gravity"]["value"]
    return values


def test_every_number_is_there(pairs):
    for _, energy in pairs:
        arm = cylinder(energy)
        assert all_finite(
            [arm.kinetic, arm.potential, arm.cap_internal, arm.rod_internal, arm.hamiltonian, arm.hamiltonian_rate,
             arm.dissipation, arm.supply, arm.balance_residual, energy.pump_power, energy.bypass_loss,
             energy.metering_loss]
        )  # fmt: skip
        assert all_finite([term.power for term in arm.terms])


def test_sums_are_sums(pairs):
    for _, energy in pairs:
        arm = cylinder(energy)
        stored = arm.kinetic + arm.potential + arm.cap_internal + arm.rod_internal
        assert arm.hamiltonian == pytest.approx(stored)
        assert arm.dissipation == pytest.approx(sum(term.power for term in arm.terms), abs=1e-6)
        left = arm.hamiltonian_rate - (arm.dissipation + arm.supply)
        assert arm.balance_residual == pytest.approx(left, abs=1e-6)


def test_the_arm_dissipates(pairs):
    names = set()
    for _, energy in pairs:
        arm = cylinder(energy)
        assert arm.dissipation <= 1e-9
        assert all(term.power <= 1e-9 for term in arm.terms)
        names |= {term.effect for term in arm.terms}
    assert {"viscous_damping", "coulomb_friction", "internal_leakage"} <= names


def test_kinetic_energy_is_that_of_the_joint_rate(pairs, parameters):
    """J qd^2 / 2, (9) of the paper; qd here from the joint angles of neighbouring samples."""
    energies, expected = [], []
    for (before, _), (_, energy), (after, _) in zip(pairs, pairs[1:], pairs[2:]):
        (span,) = steps([before, after])
        rate = (cylinder(after).joint_angle - cylinder(before).joint_angle) / span
        expected.append(0.5 * parameters["arm.inertia"] * rate**2)
        energies.append(cylinder(energy).kinetic)
    assert max(expected) > 0.01
    scale = max(expected)
    assert all(energy == pytest.approx(wanted, abs=0.05 * scale) for energy, wanted in zip(energies, expected))


def test_potential_energy_is_that_of_the_angle(pairs, parameters):
    weight = parameters["arm.gravity_moment"] * parameters["gravity"]
    for state, energy in pairs:
        expected = -weight * math.cos(cylinder(state).joint_angle + parameters["base_angle"])
        assert cylinder(energy).potential == pytest.approx(expected, abs=1e-3 * weight)


def test_oil_stores_what_its_pressure_says(pairs, parameters):
    """V p^2 / (2 beta) to first order; the terms of higher order are below 2 % up to 20 MPa."""
    for state, energy in pairs:
        arm, stored = cylinder(state), cylinder(energy)
        extended = parameters["stroke"] / 2 + arm.displacement
        retracted = parameters["stroke"] / 2 - arm.displacement
        cap = parameters["cap_dead_volume"] + parameters["cap_area"] * extended
        rod = parameters["rod_dead_volume"] + parameters["rod_area"] * retracted
        spring = 2 * parameters["arm.bulk_modulus"]
        assert stored.cap_internal == pytest.approx(cap * arm.cap_pressure**2 / spring, rel=0.02, abs=1e-3)
        assert stored.rod_internal == pytest.approx(rod * arm.rod_pressure**2 / spring, rel=0.02, abs=1e-3)


def test_pump_power_is_the_energy_of_compressed_oil(pairs, parameters):
    modulus = parameters["pump.bulk_modulus"]
    for state, energy in pairs:
        expected = modulus * math.expm1(state.pump_pressure / modulus) * state.pump_flow
        assert energy.pump_power == pytest.approx(expected, rel=0.05)


def test_throttles_take_power_out(pairs):
    assert all(energy.bypass_loss >= 0.0 and energy.metering_loss >= 0.0 for _, energy in pairs)
    assert max(energy.metering_loss for _, energy in pairs) > 1.0


def test_the_balance_closes(pairs):
    """The model is the machine's own: over the whole motion what is left over is small against what went through."""
    through = sum(abs(cylinder(energy).supply) for _, energy in pairs)
    left = abs(sum(cylinder(energy).balance_residual for _, energy in pairs))
    assert through > 0.0
    assert left < 0.1 * through
