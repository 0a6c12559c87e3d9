"""Models: a machine and a list of physical effects."""

from __future__ import annotations

import html
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from numpy.typing import ArrayLike

from . import _native
from ._errors import ModelError, remark
from ._recording import TIME, Path, Recording

Catalogue = Path | Mapping[str, Any] | Sequence[Mapping[str, Any]]
Inputs = Recording | Path | Mapping[str, Any]


@dataclass(frozen=True)
class Effect:
    """A physical effect of a model."""

    name: str
    """Name in the catalogue."""
    at: str
    """Where it acts: a cylinder, `pump` or `machine`."""
    summary: str
    """Description in one sentence."""
    equation: str
    """Its formula."""

    def __str__(self) -> str:
        return f"{self.name}@{self.at}"


@dataclass(frozen=True)
class Parameter:
    """A parameter of a model."""

    value: float
    """Value in `unit`."""
    unit: str
    """SI unit; `-` if dimensionless."""
    known: bool
    """Whether it is a constant that identification does not change."""
    standard_error: float | None
    """Standard error of an identified value."""
    margin_95: float | None
    """Half the width of the 95 % interval of an identified value."""
    meaning: str
    """Meaning of the parameter."""
    source: str
    """Source of the value."""
    minimum: float
    """Smallest plausible value."""
    maximum: float
    """Largest plausible value."""
    effect: str
    """Effect to which it belongs."""

    def __float__(self) -> float:
        return self.value


class Model:
    """A machine plus a list of physical effects.

    `set` changes a value in place. Methods whose names begin with `with` return a new model and leave this one unchanged.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.Model) -> None:
        self._native = native

    @classmethod
    def load(cls, path: Path, *, catalogue: Catalogue | Sequence[Path] | None = None) -> Model:
        """Loads a built-in model by name (`Model.built_in()` lists them), or a model file (TOML).

        `catalogue` adds your own effects, as in `with_catalogue`.
        """
        model = cls(_native.Model.load(path))
        return model if catalogue is None else model.with_catalogue(catalogue)

    @classmethod
    def from_toml(cls, text: str, *, name: str = "model") -> Model:
        """Creates a model from the text of a model file. `name` is used in messages."""
        return cls(_native.Model.from_toml(text, name))

    @classmethod
    def template(cls, name: str) -> Model:
        """Returns a model from an example data sheet, for a kind of machine that no built-in model covers. `Model.templates()` lists the names."""
        known = dict(_native.Model.templates())
        if name not in known:
            raise ModelError(f'no template "{name}"; there are {", ".join(known)}')
        return cls(known[name])

    @staticmethod
    def templates() -> list[str]:
        """Returns the names of the templates."""
        return [name for name, _ in _native.Model.templates()]

    @staticmethod
    def built_in() -> list[str]:
        """Returns the names of the built-in models."""
        return _native.Model.built_in()

    @property
    def name(self) -> str:
        """Name of the machine."""
        return self._native.name

    @property
    def description(self) -> str:
        """Description of the machine."""
        return self._native.description

    @property
    def cylinders(self) -> list[str]:
        """Names of the cylinders."""
        return self._native.cylinders

    @property
    def effects(self) -> list[Effect]:
        """The effects, in the order in which they act."""
        return [Effect(*one) for one in self._native.effects()]

    @property
    def catalogue(self) -> dict[str, str]:
        """Every effect that can be added to the model, by name, with a description in one sentence."""
        return dict(self._native.catalogue())

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The parameters, by name (`arm.inertia`)."""
        return {name: Parameter(*row, effect) for name, effect, row in self._native.parameters()}

    @property
    def history(self) -> list[tuple[str, str]]:
        """Changes to the model: time (ISO 8601) and description of each."""
        return self._native.history()

    def __getitem__(self, name: str) -> float:
        """Returns the value of a parameter, in its SI unit."""
        return self.parameters[name].value

    def set(self, name: str, value: float, *, known: bool | None = None, source: str | None = None) -> None:
        """Sets a parameter, in its SI unit. `known=True` makes it a constant that identification does not change; `known=False` makes it
        unknown, so that identification estimates it."""
        self._native = self._native.with_value(name, float(value), known, source)

    def copy(self) -> Model:
        """Returns a copy of the model."""
        return Model(self._native)

    def with_values(self, values: Mapping[str, float]) -> Model:
        """Returns a model with other parameter values, in their SI units."""
        other = self.copy()
        for name, value in values.items():
            other.set(name, value)
        return other

    def with_effect(
        self, effect: str | Mapping[str, Any], at: str | None = None, *, values: Mapping[str, float] | None = None
    ) -> Model:
        """Returns a model with one more effect.

        `effect` is a name from the catalogue (`"pump_leakage"`, `"load_damping@arm"`), or a formula as a `dict` with the keys of a
        catalogue file (`name`, `acts_on`, `formula`, `parameters`, ...)::

            model.with_effect(
                {
                    "name": "load_damping",
                    "acts_on": "piston_force",
                    "formula": "-k*v*abs(p_cap - p_rod)",
                    "parameters": {"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3]}},
                },
                at="arm",
            )

        `excavator.law` creates such a `dict` from a Python function.

        `at` is a cylinder, `pump` or `machine`. By default, the effect acts at every possible place. Its parameters have their start
        values unless `values` overrides them (`{"k": 2e-3}`).
        """
        model = self
        if isinstance(effect, Mapping):
            model = self.with_catalogue([effect])
            effect = str(effect["name"])
        name = effect if at is None else f"{effect.partition('@')[0]}@{at}"
        other = Model(model._native.with_effect(name))
        wanted = name.partition("@")[0]
        for parameter, value in (values or {}).items():
            own = [
                full
                for full, row in other.parameters.items()
                if row.effect == wanted and full.rpartition(".")[2] == parameter and full not in self.parameters
            ]
            if not own:
                raise ModelError(f'effect {wanted} has no parameter "{parameter}"')
            for full in own:
                other.set(full, value)
        return other

    def without_effect(self, name: str) -> Model:
        """Returns a model without an effect: `EFFECT@PLACE`, or `EFFECT` at every place."""
        return Model(self._native.without_effect(name))

    def with_catalogue(self, catalogue: Catalogue | Sequence[Path]) -> Model:
        """Returns a model whose catalogue includes your own effects. They are not yet active: `diagnose` tries them, and you can add them by name.

        `catalogue` is a file (TOML) or a folder with such files, a formula as a `dict`, or a list of these.
        """
        native = self._native
        for text, name in _catalogues(catalogue):
            native = native.with_catalogue(text, name)
        return Model(native)

    def simulate(
        self,
        inputs: Inputs,
        *,
        start: Mapping[str, float] | None = None,
        accept: Sequence[str] = (),
    ) -> Recording:
        """Simulates the model.

        `inputs` is one of:

        - a `Recording`: its inputs are used, and the simulation starts from its first measured state;
        - arrays by name with their times: `{"time": t, "arm.orifice_command": u}`, starting at rest;
        - a profile of sines, sweeps, trapezoids and holds: a file (TOML), or a `dict` with the same keys, starting at rest.

        `start` is the displacement of each cylinder at rest, m from mid-stroke. A `Recording` and a profile file have a start of their own.
        `accept` overrules checks of a recording, by name.
        """
        if start and isinstance(inputs, (Recording, str, os.PathLike)):
            raise ModelError("start= is for arrays and for profiles as a dict: a recording starts from its first state, a profile file from its own start")
        if isinstance(inputs, Recording):
            usage = {"accept": list(accept), "conditions": [], "whole": True}
            simulated, remarks = _native.simulate(self._native, inputs._native, usage)
            remark(remarks)
            return Recording(simulated)
        if isinstance(inputs, (str, os.PathLike)) or "profiles" in inputs:
            if isinstance(inputs, Mapping):
                inputs = dict(inputs) | ({"start": dict(start)} if start else {})
            return Recording(self._native.simulate_profile(inputs))
        return Recording(self._native.simulate_commands(_commands(inputs)._native, dict(start or {})))

    def to_toml(self) -> str:
        """Returns the text of a model file, including the formulas of your own effects."""
        return self._native.to_toml()

    def save(self, path: Path, *, replace: bool = False) -> None:
        """Writes a model file that the program can read."""
        with open(path, "w" if replace else "x", encoding="utf-8") as file:
            file.write(self.to_toml())

    def __repr__(self) -> str:
        return f"<Model {self.name}: {len(self.effects)} effects, {len(self.parameters)} parameters>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Model.from_toml, (self.to_toml(),)

    def _repr_html_(self) -> str:
        rows = []
        for name, one in self.parameters.items():
            margin = "" if one.margin_95 is None else f"{one.margin_95:.2g}"
            cells = f"{one.value:.6g}", margin, html.escape(one.unit), "known" if one.known else "", html.escape(one.effect)
            rows.append(f"<tr><th>{html.escape(name)}</th>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
        heads = "".join(f"<th>{head}</th>" for head in ("parameter", "value", "± 95 %", "unit", "", "effect"))
        lead = f"{html.escape(self.name)}: {html.escape(self.description)}"
        return f"<p>{lead}</p><table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _commands(inputs: Mapping[str, ArrayLike]) -> Recording:
    signals = dict(inputs)
    if TIME not in signals:
        raise ModelError('inputs need their times: {"time": ..., "arm.orifice_command": ...}')
    return Recording.from_arrays(signals.pop(TIME), signals, source="inputs")


def _catalogues(catalogue: Catalogue | Sequence[Path]) -> list[tuple[str, str]]:
    """Returns the text and name of each catalogue file."""
    if isinstance(catalogue, (str, os.PathLike)):
        path = FilePath(catalogue)
        files = sorted(path.glob("*.toml")) if path.is_dir() else [path]
        if not files:
            raise ModelError(f"{path}: the folder has no catalogue files (.toml)")
        return [(file.read_text(encoding="utf-8"), str(file)) for file in files]
    if isinstance(catalogue, Mapping):
        # In a catalogue file, "formula" is the list of laws. In a single law, it is the text of the formula.
        laws = [catalogue] if isinstance(catalogue.get("formula"), str) else catalogue.get("formula", [])
        return [(_native.to_toml({"formula": list(laws)}), "the catalogue")]
    texts = []
    for one in catalogue:
        texts += _catalogues(one)
    return texts
