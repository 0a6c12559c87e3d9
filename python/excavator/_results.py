"""Results of the verbs."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _native
from ._model import Model
from ._recording import Path, Recording

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

HEIGHT = 720
"""Height of a page in a notebook, in pixels."""


class Result:
    """Result of a verb: the content of the `--json` and `--report` files of the program."""

    def __init__(self, native: _native.Outcome) -> None:
        self._native = native

    @cached_property
    def _content(self) -> dict[str, Any]:
        return json.loads(self._native.json())

    def to_dict(self) -> dict[str, Any]:
        """Returns the content of the `--json` file of the program. Non-finite numbers are `None`."""
        return json.loads(self._native.json())

    def to_json(self) -> str:
        """Returns the same content as text."""
        return self._native.json()

    def __getitem__(self, key: str) -> Any:
        """Returns one entry of `to_dict()`."""
        return self._content[key]

    @property
    def sentence(self) -> str:
        """The result in one or two sentences."""
        return self._native.sentence()

    def html(self) -> str:
        """Returns the `--report` page of the program, which is self-contained and needs no network. For verbs without a page, returns the tables."""
        page = self._native.page()
        return page if page is not None else f"<!DOCTYPE html><meta charset=utf-8>{self._tables()}"

    def page(self, path: Path, *, replace: bool = True) -> None:
        """Writes the page to a file."""
        with open(path, "w" if replace else "x", encoding="utf-8") as file:
            file.write(self.html())

    def _tables(self) -> str:
        return f"<p>{html.escape(self.sentence)}</p>"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.sentence}>"

    def _repr_html_(self) -> str:
        page = self._native.page()
        if page is None:
            return self._tables()
        # A separate frame, because the page has its own styles and draws its own plots.
        frame = f'<iframe srcdoc="{html.escape(page)}" width="100%" height="{HEIGHT}" style="border:0"></iframe>'
        return f"<p>{html.escape(self.sentence)}</p>{frame}"


class _WithModel(Result):
    @property
    def model(self) -> Model:
        """The resulting model."""
        found = self._native.model()
        assert found is not None
        return Model(found)


class _WithSignals(Result):
    @cached_property
    def recordings(self) -> dict[str, Recording]:
        """Recordings by name: `measured`, `simulated`, and any others in the comparison."""
        return {what: Recording(one) for what, one in self._native.recordings()}

    @property
    def measured(self) -> Recording:
        """Measured signals. Velocities that were not measured are derived from displacement."""
        return self.recordings["measured"]

    @property
    def simulated(self) -> Recording:
        """Signals that the model predicts for the same input."""
        return self.recordings["simulated"]

    def plot(self, *signals: str) -> Figure:
        """Plots measured and simulated signals over time. By default, plots all compared signals. Requires Matplotlib."""
        from ._plots import of_comparison

        others = {what: one for what, one in self.recordings.items() if what != "measured"}
        return of_comparison(self.measured, others, signals or self._compared())

    def _compared(self) -> list[str]:
        raise NotImplementedError


class Comparison(_WithSignals):
    """Comparison of a model with a recording."""

    @property
    def mean_nmse(self) -> float | None:
        """Mean NMSE of the signals (mean squared error divided by the variance): 0 is a perfect match; 1 is no better than a constant."""
        return self._content["mean_nmse"]

    @property
    def nmse(self) -> dict[str, float | None]:
        """NMSE by signal."""
        return {name: one["nmse"] for name, one in self._content["signals"].items()}

    def _compared(self) -> list[str]:
        return list(self._content["signals"])


class Identification(_WithModel):
    """Parameters identified from recordings. `model` has the identified values."""

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Identified parameters by name: `value`, `std_error`, `margin_95`, `unit`."""
        return _by_name(self._content["parameters"])

    @property
    def not_identified(self) -> dict[str, str]:
        """Reason for each parameter that was not identified, by name."""
        return {one["name"]: one["reason"] for one in self._content["not_identified"]}

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the identified parameters as a table. Requires pandas."""
        return _frame(self._content["parameters"])

    def plot(self) -> Figure:
        """Plots the 95 % interval of each identified parameter, relative to its value. Requires Matplotlib."""
        from ._plots import of_parameters

        return of_parameters(self._content["parameters"])

    def _tables(self) -> str:
        rows = ((one["name"], one["value"], one["margin_95"], one["unit"]) for one in self._content["parameters"])
        table = _table(("parameter", "value", "± 95 %", "unit"), rows)
        gone = "".join(f"<li>{html.escape(f'{name}: {why}')}</li>" for name, why in self.not_identified.items())
        return super()._tables() + table + (f"<p>Not identified:</p><ul>{gone}</ul>" if gone else "")


class Diagnosis(_WithModel):
    """Diagnosis of the physical effect that a model is missing. `model` is the model that the verdict supports."""

    @property
    def verdict(self) -> str:
        """`adequate`, `missing_effect` or `unexplained`."""
        return self._content["verdict"]

    @property
    def candidates(self) -> list[dict[str, Any]]:
        """Effects with evidence, best first."""
        return self._content["candidates"]

    def to_pandas(self) -> pandas.DataFrame:
        """Returns all effects that were tried, as a table. Requires pandas."""
        nested = ("parameters", "refitted", "bootstrap")
        all_tried = self._content["candidates"] + self._content["rejected"]
        return _frame([{key: value for key, value in one.items() if key not in nested} for one in all_tried])

    def plot(self) -> Figure:
        """Plots the error on the validation recordings without and with each effect. Requires Matplotlib."""
        from ._plots import of_candidates

        return of_candidates(self._content["candidates"] + self._content["rejected"])


class Proposals(Result):
    """Laws for effects that a model is missing and that no catalogue contains, best first."""

    @property
    def laws(self) -> list[dict[str, Any]]:
        """The proposed laws, best first."""
        return self._content["proposals"]

    def to_toml(self) -> str:
        """Returns the laws as the text of a catalogue file, with fitted values."""
        return self._native.file() or ""

    def save(self, path: Path, *, replace: bool = False) -> None:
        """Writes the catalogue file, for `Model.with_catalogue`."""
        with open(path, "w" if replace else "x", encoding="utf-8") as file:
            file.write(self.to_toml())

    def plot(self) -> Figure:
        """Plots the error on the validation recordings without and with each law. Requires Matplotlib."""
        from ._plots import of_candidates

        return of_candidates([law | {"effect": law["formula"], "cylinder": law["at"]} for law in self.laws])


class Refinement(_WithSignals, _WithModel):
    """A model with added effects, fitted and compared again. `model` is the refined model."""

    @property
    def verdict(self) -> str:
        """`adequate`, `missing_effect` or `unexplained`."""
        return self._content["verdict"]

    @property
    def steps(self) -> list[dict[str, Any]]:
        """The effects added at each step, and the resulting error of each signal."""
        return self._content["steps"]

    def _compared(self) -> list[str]:
        return list(self.steps[-1]["signals"])


class Design(Result):
    """A manoeuvre that separates effects, or makes a parameter identifiable."""

    @property
    def profile(self) -> str | None:
        """Text of the profile file (TOML), for `Model.simulate` and the program. `None` if no manoeuvre is expected to be sufficient."""
        return self._native.file()

    def save(self, path: Path, *, replace: bool = False) -> None:
        """Writes the profile file."""
        if self.profile is None:
            raise ValueError("no manoeuvre is expected to be enough, there is no profile")
        with open(path, "w" if replace else "x", encoding="utf-8") as file:
            file.write(self.profile)

    def _tables(self) -> str:
        plan = self._content["plan"]["manoeuvres"]
        lead = super()._tables() + _table(("begins at, s", "manoeuvre"), ((one["start"], one["name"]) for one in plan))
        if "pairs" not in self._content:
            errors = "value", "std_error_given", "std_error_on_sines", "std_error_expected", "std_error_trial_run"
            return lead + _table(("", self._content["unit"]), ((key, self._content[key]) for key in errors))
        heads = "first", "second", "distance", "expected_improvement", "expected_significance", "separated"
        return lead + _table(heads, ([pair[key] for key in heads] for pair in self._content["pairs"]))


class Energy(Result):
    """Where the energy of a recording went, and whether the energy ledger of the model closes."""

    @property
    def closes(self) -> bool:
        """Whether noise explains the residual of every equation."""
        return self._content["ledger_closes"]

    @property
    def losses(self) -> dict[str, float]:
        """Energy that each effect took from the cylinders and the pump line, J."""
        effects = self._content["energy"]["effects"]
        # Unknown values are None.
        taken = [-((one["into_cylinders"] or 0.0) + (one["into_pump_line"] or 0.0)) for one in effects]
        return {f"{one['effect']}@{one['at']}": energy for one, energy in zip(effects, taken, strict=True)}

    def plot(self) -> Figure:
        """Plots the energy that each effect took, J. Requires Matplotlib."""
        from ._plots import of_bars

        return of_bars(self.losses, "energy, J")


class Characterisation(Result):
    """Valve and friction properties, determined from recordings without a simulation."""

    @property
    def cylinders(self) -> dict[str, dict[str, Any]]:
        """Properties of each cylinder, by name."""
        return _by_name(self._content["cylinders"])


def _by_name(rows: Iterable[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return {row["name"]: row for row in rows}


def _frame(rows: list[dict[str, Any]]) -> pandas.DataFrame:
    from ._optional import needed

    return needed("pandas", "to_pandas").DataFrame(rows)


def _table(heads: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    def cell(value: Any) -> str:
        text = f"{value:.5g}" if isinstance(value, float) else "" if value is None else str(value)
        return f"<td>{html.escape(text)}</td>"

    head = "".join(f"<th>{html.escape(text)}</th>" for text in heads)
    body = "".join(f"<tr>{''.join(cell(value) for value in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
