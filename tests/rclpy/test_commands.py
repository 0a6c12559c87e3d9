"""A command moves the arm, in the direction of its sign, and the pressures follow."""

import statistics

import pytest
from support.simulator import CREEP, Simulator, cylinder, steps

# Wide enough that the closing open centre lifts the pump above the pressure that carries the arm; below some 7e-5 m2
# oil flows back out of the cap side, since the machine has no load-holding valve.
AREA = 1e-4


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator)


def mean(states, field):
    return statistics.fmean(getattr(cylinder(state), field) for state in states)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_sign_of_the_area_is_the_direction_of_the_piston(simulator, sign):
    rest = simulator.settle()
    moving = simulator.hold(0.8, arm=sign * AREA)
    assert cylinder(moving[-1]).orifice_area == pytest.approx(sign * AREA)
    travelled = cylinder(moving[-1]).displacement - cylinder(rest).displacement
    assert sign * travelled > 0.005
    steady = moving[len(moving) // 2 :]
    assert sign * mean(steady, "velocity") > 0.005
    # the velocity is the derivative of the displacement
    speeds = [cylinder(state).velocity for state in steady]
    way = sum((one + next_one) / 2 * step for one, next_one, step in zip(speeds, speeds[1:], steps(steady)))
    assert cylinder(steady[-1]).displacement - cylinder(steady[0]).displacement == pytest.approx(way, rel=0.05)


@pytest.mark.parametrize("sign", [1.0, pytest.param(-1.0, marks=pytest.mark.full)])
def test_oil_flows_from_higher_to_lower_pressure(simulator, sign):
    """Pump to the chamber that fills, and the other chamber to the tank: (11) of the paper has no other way."""
    simulator.settle()
    moving = simulator.hold(0.8, arm=sign * AREA)
    steady = moving[len(moving) // 2 :]
    fills, empties = ("cap_pressure", "rod_pressure") if sign > 0 else ("rod_pressure", "cap_pressure")
    pump = statistics.fmean(state.pump_pressure for state in steady)
    tank = statistics.fmean(state.tank_pressure for state in steady)
    assert pump > mean(steady, fills)
    assert mean(steady, empties) > tank


def test_a_wider_valve_is_faster(simulator):
    speeds = []
    for area in (0.8 * AREA, 1.1 * AREA):
        simulator.settle()
        moving = simulator.hold(0.6, arm=area)
        speeds.append(mean(moving[len(moving) // 2 :], "velocity"))
    assert speeds[1] > 1.5 * speeds[0] > 0.0


def test_the_arm_stands_when_the_command_is_zero(simulator):
    simulator.hold(0.3, arm=AREA)
    standing = simulator.hold(1.0, arm=0.0)
    assert cylinder(standing[-1]).orifice_area == 0.0
    assert abs(mean(standing[-20:], "velocity")) < CREEP
