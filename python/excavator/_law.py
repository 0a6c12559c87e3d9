"""Converts Python functions to physical laws: a function is called once with symbols, and its computation is recorded as a formula."""

from __future__ import annotations

import inspect
import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from ._errors import ModelError

# Operator precedence. Formulas contain parentheses only where they are needed.
SUM, PRODUCT, SIGN, POWER, ATOM = range(1, 6)

# NumPy functions and their names in formulas.
CALLS = {
    np.absolute: "abs",
    np.fabs: "abs",
    np.sign: "sign",
    np.sqrt: "sqrt",
    np.exp: "exp",
    np.log: "ln",
    np.log10: "log10",
    np.sin: "sin",
    np.cos: "cos",
    np.tan: "tan",
    np.tanh: "tanh",
    np.arctan: "atan",
    np.minimum: "min",
    np.fmin: "min",
    np.maximum: "max",
    np.fmax: "max",
}


class Symbol(NDArrayOperatorsMixin):
    """A quantity of a law. Python arithmetic and NumPy functions on it build a formula."""

    __slots__ = ("binds", "text")
    __hash__ = object.__hash__

    def __init__(self, text: str, binds: int = ATOM) -> None:
        self.text = text
        self.binds = binds

    def within(self, least: int) -> str:
        """Returns the text, in parentheses if the surrounding operation has a higher precedence."""
        return self.text if self.binds >= least else f"({self.text})"

    def __bool__(self) -> bool:
        raise ModelError(f'a law cannot branch on "{self.text}": write numpy.where(x > 0, a, b) in place of if')

    def __float__(self) -> float:
        raise ModelError(f'"{self.text}" has no value yet: use functions of NumPy (numpy.tanh in place of math.tanh)')

    def __array_ufunc__(self, function: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        # `x += 1` passes x as `out`. The result is a new symbol, bound to the same name.
        into = options.pop("out", ())
        if method != "__call__" or options or not all(isinstance(one, Symbol) for one in into):
            raise ModelError(f"a formula has no numpy.{function.__name__}.{method}")
        if function in OPERATORS:
            return OPERATORS[function](*inputs)
        if function in CALLS:
            return call(CALLS[function], *inputs)
        known = ", ".join(sorted({one.__name__ for one in CALLS}))
        raise ModelError(f"a formula has no numpy.{function.__name__}; it has {known}, where, clip")

    def __array_function__(self, function: Callable[..., Any], types: Any, args: tuple[Any, ...], options: Any) -> Any:
        return _numpy_function(function, args)

    def __repr__(self) -> str:
        return self.text


class Condition:
    """A comparison of two quantities, for `numpy.where`."""

    __slots__ = ("text",)

    def __init__(self, left: Any, operator: str, right: Any) -> None:
        self.text = f"{_symbol(left).text} {operator} {_symbol(right).text}"

    def __bool__(self) -> bool:
        raise ModelError(f'a law cannot branch on "{self.text}": write numpy.where({self.text}, a, b) in place of if')

    def __array_function__(self, function: Callable[..., Any], types: Any, args: tuple[Any, ...], options: Any) -> Any:
        return _numpy_function(function, args)


def _numpy_function(function: Callable[..., Any], args: tuple[Any, ...]) -> Symbol:
    if function is np.where and len(args) == 3:
        return where(*args)
    if function is np.clip and len(args) == 3:
        return call("clamp", *args)
    raise ModelError(f"a formula has no numpy.{function.__name__}")


def _equality(left: Any, right: Any) -> Any:
    # Equality of two symbols cannot be decided here. A silent "not equal" would select a branch.
    told = left if isinstance(left, Symbol) else right
    raise ModelError(f'a formula has no "==", as with "{told}": compare with < or >, in numpy.where')


def call(function: str, *arguments: Any) -> Symbol:
    """Returns a call of a function of the formula language, by its name there."""
    return Symbol(f"{function}({', '.join(_symbol(one).text for one in arguments)})")


def where(condition: Condition, holds: Any, otherwise: Any) -> Symbol:
    """Returns `holds` where the condition holds, else `otherwise`. The transition is smoothed, as at every corner of a formula."""
    if not isinstance(condition, Condition):
        raise ModelError("numpy.where in a law needs one comparison, as in numpy.where(v > 0, a, b)")
    return Symbol(f"if({condition.text}, {_symbol(holds).text}, {_symbol(otherwise).text})")


def root(x: Any) -> Any:
    """Returns sign(x) sqrt(abs(x)), like the flow through an orifice. In a formula, the slope at zero is finite."""
    if isinstance(x, Symbol):
        return call("root", x)
    return np.sign(x) * np.sqrt(np.abs(x))


def table(x: Any, knots: Sequence[float], values: Sequence[float]) -> Symbol:
    """Returns a monotone cubic through the given points. `knots` are in the SI unit of `x`; the result is dimensionless."""
    lists = (f"[{', '.join(_number(one) for one in row)}]" for row in (knots, values))
    return Symbol(f"table({_symbol(x).text}, {', '.join(lists)})")


def law(
    function: Callable[..., Any],
    *,
    acts_on: str,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    states: Mapping[str, Mapping[str, Any]] | None = None,
    name: str | None = None,
    summary: str | None = None,
) -> dict[str, Any]:
    """Converts a Python function to a law, in the form that `Model.with_effect` and `Model.with_catalogue` accept.

    The function is called once, with symbols in place of numbers, and its result becomes the formula. A law in Python is therefore as
    fast as one in text, has exact derivatives and is stored in the model file. Arguments are machine variables, parameters and states,
    by name. An argument with a string default refers to the variable of that name (`boom_speed="boom.v"`)::

        def load_damping(v, p_cap, p_rod, k):
            \"\"\"Damping that grows with the load.\"\"\"
            return -k * v * abs(p_cap - p_rod)

        excavator.law(
            load_damping,
            acts_on="piston_force",
            parameters={"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3]}},
        )

    The function may use arithmetic, the NumPy functions that formulas support (including `numpy.where`, `numpy.clip` and `numpy.tanh`),
    `excavator.root` and `excavator.table`. It may loop a fixed number of times, but not branch on a quantity.

    Args:
        function: the law, in the SI unit of what it acts on.
        acts_on: the equation that the law enters; it sets the unit. `excavator effects --language` lists all of them.
        parameters: unit, limits, start values and meaning of each parameter, with the same keys as in a catalogue file.
        states: start, rate and unit of each state, for laws with memory. `rate` and `start` are formulas or functions.
        name: name of the effect; by default, the name of the function.
        summary: description of the effect in one sentence; by default, the first line of the function's docstring.

    Raises:
        ModelError: if the function does something that a formula cannot express.
    """
    told = name or function.__name__
    if not told.isidentifier():
        raise ModelError(f'a law needs a name: law(..., name="load_damping"); "{told}" is none')
    entry: dict[str, Any] = {"name": told, "acts_on": acts_on, "formula": _traced(function, told)}
    summary = summary or (inspect.getdoc(function) or "").partition("\n")[0]
    if summary:
        entry["summary"] = summary
    if parameters:
        entry["parameters"] = {key: dict(value) for key, value in parameters.items()}
    if states:
        entry["states"] = {key: _state(told, key, value) for key, value in states.items()}
    return entry


def _state(law_name: str, key: str, state: Mapping[str, Any]) -> dict[str, Any]:
    return {
        field: _traced(value, f"{law_name}.{key}.{field}") if callable(value) else value for field, value in state.items()
    }


def _traced(function: Callable[..., Any], told: str) -> str:
    arguments: list[Symbol] = []
    named: dict[str, Symbol] = {}
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            raise ModelError(f"{told}: a law names its arguments; *{parameter.name} has no name")
        symbol = Symbol(parameter.default if isinstance(parameter.default, str) else parameter.name)
        if parameter.kind is parameter.KEYWORD_ONLY:
            named[parameter.name] = symbol
        else:
            arguments.append(symbol)
    try:
        result = function(*arguments, **named)
    except ModelError as error:
        raise ModelError(f"{told}: {error}") from None
    if isinstance(result, Condition):
        raise ModelError(f"{told}: the result is a comparison ({result.text}), not a number")
    if result is None:
        raise ModelError(f"{told}: the function returns nothing")
    return _symbol(result).text


def _number(value: Any) -> str:
    # repr returns the shortest text that parses to the same number.
    number = float(value)
    if not math.isfinite(number):
        raise ModelError(f"a formula has no number {number}")
    return repr(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _symbol(value: Any) -> Symbol:
    if isinstance(value, Symbol):
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, numbers.Real):
        text = _number(value)
        return Symbol(text, SIGN if text.startswith("-") else ATOM)
    raise ModelError(f"a law computes with single numbers; {type(value).__name__} is none")


def _binary(left: Any, operator: str, right: Any, binds: int) -> Symbol:
    first, second = _symbol(left), _symbol(right)
    # After "-" and "/", an operand of the same precedence needs parentheses. A signed operand gets them for readability.
    behind = ATOM if second.binds == SIGN else binds + 1 if operator in "-/" else binds
    return Symbol(f"{first.within(binds)} {operator} {second.within(behind)}", binds)


def _power(base: Any, exponent: Any) -> Symbol:
    return Symbol(f"{_symbol(base).within(ATOM)}^{_symbol(exponent).within(POWER)}", POWER)


OPERATORS: dict[np.ufunc, Callable[..., Any]] = {
    np.add: lambda left, right: _binary(left, "+", right, SUM),
    np.subtract: lambda left, right: _binary(left, "-", right, SUM),
    np.multiply: lambda left, right: _binary(left, "*", right, PRODUCT),
    np.true_divide: lambda left, right: _binary(left, "/", right, PRODUCT),
    np.power: _power,
    np.float_power: _power,
    np.square: lambda x: _power(x, 2),
    np.negative: lambda x: Symbol(f"-{_symbol(x).within(POWER)}", SIGN),
    np.positive: lambda x: x,
    np.less: lambda left, right: Condition(left, "<", right),
    np.less_equal: lambda left, right: Condition(left, "<=", right),
    np.greater: lambda left, right: Condition(left, ">", right),
    np.greater_equal: lambda left, right: Condition(left, ">=", right),
    np.equal: _equality,
    np.not_equal: _equality,
}
