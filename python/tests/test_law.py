"""Laws from Python functions: the formulas compute the same values as the functions."""

import math

import numpy as np
import pytest

import excavator
from excavator._law import Symbol

K = {"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3]}}


def load_damping(v, p_cap, p_rod, k):
    """Damping that grows with the load.

    More about it."""
    return -k * v * abs(p_cap - p_rod)


def test_a_function_is_the_law_in_text():
    law = excavator.law(load_damping, acts_on="piston_force", parameters=K)
    assert law["formula"] == "-k * v * abs(p_cap - p_rod)"
    assert law["summary"] == "Damping that grows with the load."
    model = excavator.Model.load("zx30u-arm")
    text = {"name": "load_damping", "acts_on": "piston_force", "formula": "-k*v*abs(p_cap - p_rod)", "parameters": K}
    commands = {"time": np.linspace(0.0, 1.0, 101), "arm.orifice_command": np.full(101, 30e-6)}
    traced, written = (model.with_effect(one, at="arm").simulate(commands) for one in (law, text))
    assert np.array_equal(traced["arm.displacement"], written["arm.displacement"])
    # The law has an effect: without it, the arm ends at a different position.
    assert not np.array_equal(traced["arm.displacement"], model.simulate(commands)["arm.displacement"])
    # The model file contains it.
    again = excavator.Model.from_toml(model.with_effect(law, at="arm").to_toml())
    assert "load_damping" in [effect.name for effect in again.effects]


def added_up(x, y):
    total = 2.0 * x
    total -= y
    total *= x
    return total + x


SHAPES = [
    lambda x, y: x - (y - x) - (x + y),
    lambda x, y: x / (y * x) / y * (x / y),
    lambda x, y: -(x**2) + (-x) ** 2 - 2**x**2 + (2**x) ** y,
    lambda x, y: x * -y - -x + -(-y) + -(x + y) / -(x * y),
    lambda x, y: 1 - x * (y + 1) ** -0.5 + 1e-7 * x - np.float64(2.5) * y,
    lambda x, y: np.tanh(x) * np.maximum(x, y) + np.square(x) / np.sqrt(y) + np.exp(-x) * np.log(y) - np.arctan(x),
    lambda x, y: np.clip(x, 0.5, 2.0) + np.minimum(x, 3.0 * y) - np.power(x, 3) + (+x),
    lambda x, y: np.where(x > y, x - y, -(y - x) * 2) + abs(x - y),
    lambda x, y: sum(c * x**n for n, c in enumerate([0.1, -0.2, 0.3])),
    lambda x, y: added_up(x, y),
]


@pytest.mark.parametrize("function", SHAPES, ids=range(len(SHAPES)))
def test_a_formula_computes_what_the_function_computes(function):
    """Evaluates the formula in Python, with `^` as the power and formula functions by name. Both return the same numbers."""
    formula = excavator.law(function, acts_on="piston_force", name="shape")["formula"]
    names = {"clamp": np.clip, "ln": math.log, "atan": math.atan, "choice": lambda c, a, b: a if c else b}
    names |= {name: getattr(np, name) for name in ("tanh", "exp", "sqrt", "abs")}
    code = formula.replace("^", "**").replace("if(", "choice(")
    for x, y in [(0.7, 1.3), (2.1, 0.4), (1.5, 1.25)]:
        assert eval(code, names | {"x": x, "y": y}) == pytest.approx(float(function(x, y)), rel=1e-12), formula


def test_laws_have_memory_and_other_cylinders():
    law = excavator.law(
        lambda z, F, boom_speed="boom.v": -F * z * np.tanh(boom_speed / 0.01),
        name="seal",
        acts_on="piston_force",
        parameters={"F": {"unit": "N/m", "maximum": 1e6, "start": [100.0]}},
        states={"z": {"start": "0", "rate": lambda v, z: v - abs(v) * z / 1e-4, "unit": "m"}},
    )
    assert law["formula"] == "-F * z * tanh(boom.v / 0.01)"
    assert law["states"]["z"]["rate"] == "v - abs(v) * z / 0.0001"


def test_tables_and_roots():
    law = excavator.law(
        lambda v, p_cap: excavator.table(v, [-0.5, 0, 0.5], [-1, 0, 2.5]) * excavator.root(p_cap), name="t", acts_on="piston_force"
    )
    assert law["formula"] == "table(v, [-0.5, 0, 0.5], [-1, 0, 2.5]) * root(p_cap)"
    assert excavator.root(-4.0) == -2.0


def refused(function, *words):
    with pytest.raises(excavator.ModelError) as caught:
        excavator.law(function, acts_on="piston_force", name="mine")
    assert all(word in str(caught.value) for word in ("mine", *words)), caught.value


def test_what_a_formula_cannot_say_is_refused_in_one_line():
    refused(lambda v: 1.0 if v > 0 else -1.0, "branch", "numpy.where")
    refused(lambda v: 1.0 if v == 0 else -1.0, "no \"==\"")
    refused(lambda v: np.where(v != 0, 1.0, -1.0), "no \"==\"")
    refused(lambda v: math.tanh(v), "numpy.tanh")
    refused(lambda v: np.arcsin(v), "arcsin", "arctan")
    refused(lambda v: np.interp(v, [0, 1], [0, 1]), "interp")
    refused(lambda v: v + np.array([1.0, 2.0]), "single numbers")
    refused(lambda v: v * math.inf, "inf")
    refused(lambda v: v > 0, "comparison")
    refused(lambda *v: v[0], "names its arguments")
    refused(lambda v: None, "returns nothing")
    with pytest.raises(excavator.ModelError, match="needs a name"):
        excavator.law(lambda v: v, acts_on="piston_force")
    # Errors in the function itself are passed on unchanged.
    with pytest.raises(ZeroDivisionError):
        excavator.law(lambda v: v / (1 // 0), acts_on="piston_force", name="mine")
    assert repr(Symbol("v") / 3) == "v / 3"
