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
    """The cylinder where it acts, `pump` or `machine`."""
    summary: str
    """What it is, in a sentence."""
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
    """SI unit, `-` for a pure number."""
    known: bool
    """Whether it is a constant, which identification leaves alone."""
    standard_error: float | None
    """Standard error of an identified value."""
    margin_95: float | None
    """Half width of the 95 % interval of an identified value."""
    meaning: str
    """What it means."""
    source: str
    """Where the value comes from."""
    minimum: float
    """Least plausible value."""
    maximum: float
    """Largest plausible value."""
    effect: str
    """The effect that it belongs to."""

    def __float__(self) -> float:
        return self.value


class Model:
    """A machine plus a list of physical effects.

    `set` changes a value in place. Every method whose name begins with `with` gives another model and leaves this one as it is.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.Model) -> None:
        self._native = native

    @classmethod
    def load(cls, path: Path, *, catalogue: Catalogue | Sequence[Path] | None = None) -> Model:
        """A built-in model by its name (`Model.built_in()` lists them), or a model file (TOML).

        `catalogue` adds effects of your own, as in `with_catalogue`.
        """
        model = cls(_native.Model.load(path))
        return model if catalogue is None else model.with_catalogue(catalogue)

    @classmethod
    def from_toml(cls, text: str, *, name: str = "model") -> Model:
        """From the text of a model file. `name` is for messages."""
        return cls(_native.Model.from_toml(text, name))

    @classmethod
    def template(cls, name: str) -> Model:
        """A machine of a kind that no built-in model has, from an example data sheet; `Model.templates()` lists them."""
        known = dict(_native.Model.templates())
        if name not in known:
            raise ModelError(f'no template "{name}"; there are {", ".join(known)}')
        return cls(known[name])

    @staticmethod
    def templates() -> list[str]:
        """Names of the templates."""
        return [name for name, _ in _native.Model.templates()]

    @staticmethod
    def built_in() -> list[str]:
        """Names of the built-in models."""
        return _native.Model.built_in()

    @property
    def name(self) -> str:
        """Name of the machine."""
        return self._native.name

    @property
    def description(self) -> str:
        """What the machine is."""
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
        """Every effect that the model may have, with a sentence on what it is."""
        return dict(self._native.catalogue())

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The parameters by name (`arm.inertia`)."""
        return {name: Parameter(*row, effect) for name, effect, row in self._native.parameters()}

    @property
    def history(self) -> list[tuple[str, str]]:
        """What was done to the model: when (ISO 8601) and what."""
        return self._native.history()

    def __getitem__(self, name: str) -> float:
        """The value of a parameter, in its SI unit."""
        return self.parameters[name].value

    def set(self, name: str, value: float, *, known: bool | None = None, source: str | None = None) -> None:
        """Sets a parameter, in its SI unit. `known=True` makes it a constant that identification leaves alone, `False` one that it looks
        for."""
        self._native = self._native.with_value(name, float(value), known, source)

    def copy(self) -> Model:
        """The same model once more."""
        return Model(self._native)

    def with_values(self, values: Mapping[str, float]) -> Model:
        """A model with other values of parameters, in their SI units."""
        other = self.copy()
        for name, value in values.items():
            other.set(name, value)
        return other

    def with_effect(
        self, effect: str | Mapping[str, Any], at: str | None = None, *, values: Mapping[str, float] | None = None
    ) -> Model:
        """A model with one more effect.

        `effect` is a name of the catalogue (`"pump_leakage"`, `"load_damping@arm"`), or a formula as a `dict` with the keys of a catalogue
        file (`name`, `acts_on`, `formula`, `parameters`, ...)::

            model.with_effect(
                {
                    "name": "load_damping",
                    "acts_on": "piston_force",
                    "formula": "-k*v*abs(p_cap - p_rod)",
                    "parameters": {"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3]}},
                },
                at="arm",
            )

        `excavator.law` makes such a `dict` from a Python function.

        `at` is a cylinder, `pump` or `machine`; without, the effect acts at each place where it can. Its parameters have their start values
        unless `values` says otherwise (`{"k": 2e-3}`).
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
        """A model without an effect: `EFFECT@PLACE`, or `EFFECT` wherever it is."""
        return Model(self._native.without_effect(name))

    def with_catalogue(self, catalogue: Catalogue | Sequence[Path]) -> Model:
        """A model that may have effects of your own; it does not have them yet. They compete in `diagnose` and can be added by name.

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

        - a `Recording`, whose inputs are used, from the state measured at its start;
        - arrays by name with their times: `{"time": t, "arm.orifice_command": u}`, from rest;
        - a profile of sines, sweeps, trapezoids and holds: a file (TOML), or a `dict` with the same keys, from rest.

        `start` is the displacement of each cylinder at rest, m from mid-stroke. `accept` overrules checks of a recording, by name.
        """
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
        """The text of a model file. It brings its formulas along."""
        return self._native.to_toml()

    def save(self, path: Path, *, replace: bool = False) -> None:
        """Writes a model file, which the program reads."""
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
    """Texts of catalogue files with their names."""
    if isinstance(catalogue, (str, os.PathLike)):
        path = FilePath(catalogue)
        files = sorted(path.glob("*.toml")) if path.is_dir() else [path]
        if not files:
            raise ModelError(f"{path}: the folder has no catalogue files (.toml)")
        return [(file.read_text(encoding="utf-8"), str(file)) for file in files]
    if isinstance(catalogue, Mapping):
        # In the content of a file, "formula" is the list of laws; in one law, it is its formula.
        laws = [catalogue] if isinstance(catalogue.get("formula"), str) else catalogue.get("formula", [])
        return [(_native.to_toml({"formula": list(laws)}), "the catalogue")]
    texts = []
    for one in catalogue:
        texts += _catalogues(one)
    return texts
