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
"""Height of a page in a notebook, pixels."""


class Result:
    """The result of a verb: the content of the program's `--json` and `--report`."""

    def __init__(self, native: _native.Outcome) -> None:
        self._native = native

    @cached_property
    def _content(self) -> dict[str, Any]:
        return json.loads(self._native.json())

    def to_dict(self) -> dict[str, Any]:
        """The content of the program's `--json`; what is not a number is `None`."""
        return json.loads(self._native.json())

    def to_json(self) -> str:
        """The same as text."""
        return self._native.json()

    def __getitem__(self, key: str) -> Any:
        """One entry of `to_dict()`."""
        return self._content[key]

    @property
    def sentence(self) -> str:
        """The result in a sentence or two."""
        return self._native.sentence()

    def html(self) -> str:
        """The page of the program's `--report`: everything is in it, and it needs no network. For verbs without a page, the tables."""
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
        # A frame of its own: the page has its own styles and draws its own plots.
        frame = f'<iframe srcdoc="{html.escape(page)}" width="100%" height="{HEIGHT}" style="border:0"></iframe>'
        return f"<p>{html.escape(self.sentence)}</p>{frame}"


class _WithModel(Result):
    @property
    def model(self) -> Model:
        """The model that was found."""
        found = self._native.model()
        assert found is not None
        return Model(found)


class _WithSignals(Result):
    @cached_property
    def recordings(self) -> dict[str, Recording]:
        """Signals over time: `measured`, `simulated`, and those beside them."""
        return {what: Recording(one) for what, one in self._native.recordings()}

    @property
    def measured(self) -> Recording:
        """What was measured; velocities that were not measured are derived from displacement."""
        return self.recordings["measured"]

    @property
    def simulated(self) -> Recording:
        """What the model does with the same input."""
        return self.recordings["simulated"]

    def plot(self, *signals: str) -> Figure:
        """Measured and simulated signals over time; without names, all that were compared. Needs Matplotlib."""
        from ._plots import of_comparison

        others = {what: one for what, one in self.recordings.items() if what != "measured"}
        return of_comparison(self.measured, others, signals or self._compared())

    def _compared(self) -> list[str]:
        raise NotImplementedError


class Comparison(_WithSignals):
    """A model beside a recording."""

    @property
    def mean_nmse(self) -> float | None:
        """Mean over the signals of the squared error divided by the variance: 0 is perfect, 1 is no better than a constant."""
        return self._content["mean_nmse"]

    @property
    def nmse(self) -> dict[str, float | None]:
        """The same by signal."""
        return {name: one["nmse"] for name, one in self._content["signals"].items()}

    def _compared(self) -> list[str]:
        return list(self._content["signals"])


class Identification(_WithModel):
    """Parameters from recordings. `model` has the identified values."""

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Identified parameters by name: `value`, `std_error`, `margin_95`, `unit`."""
        return _by_name(self._content["parameters"])

    @property
    def not_identified(self) -> dict[str, str]:
        """Parameters without a value, with the reason."""
        return {one["name"]: one["reason"] for one in self._content["not_identified"]}

    def to_pandas(self) -> pandas.DataFrame:
        """Identified parameters as a table. Needs pandas."""
        return _frame(self._content["parameters"])

    def plot(self) -> Figure:
        """Identified values relative to themselves, with their 95 % intervals. Needs Matplotlib."""
        from ._plots import of_parameters

        return of_parameters(self._content["parameters"])

    def _tables(self) -> str:
        rows = ((one["name"], one["value"], one["margin_95"], one["unit"]) for one in self._content["parameters"])
        table = _table(("parameter", "value", "± 95 %", "unit"), rows)
        gone = "".join(f"<li>{html.escape(f'{name}: {why}')}</li>" for name, why in self.not_identified.items())
        return super()._tables() + table + (f"<p>Not identified:</p><ul>{gone}</ul>" if gone else "")


class Diagnosis(_WithModel):
    """Which physical effect a model is missing. `model` is the one that the verdict supports."""

    @property
    def verdict(self) -> str:
        """`adequate`, `missing_effect` or `unexplained`."""
        return self._content["verdict"]

    @property
    def candidates(self) -> list[dict[str, Any]]:
        """Effects of the verdict, best first."""
        return self._content["candidates"]

    def to_pandas(self) -> pandas.DataFrame:
        """All effects that were tried, as a table. Needs pandas."""
        nested = ("parameters", "refitted", "bootstrap")
        all_tried = self._content["candidates"] + self._content["rejected"]
        return _frame([{key: value for key, value in one.items() if key not in nested} for one in all_tried])

    def plot(self) -> Figure:
        """Error on the validation recordings without and with each effect. Needs Matplotlib."""
        from ._plots import of_candidates

        return of_candidates(self._content["candidates"] + self._content["rejected"])


class Proposals(Result):
    """Laws for what a model is missing and no catalogue has, best first."""

    @property
    def laws(self) -> list[dict[str, Any]]:
        """The proposed laws, best first."""
        return self._content["proposals"]

    def to_toml(self) -> str:
        """The laws as a catalogue file, with fitted values."""
        return self._native.file() or ""

    def save(self, path: Path, *, replace: bool = False) -> None:
        """Writes the catalogue file, for `Model.with_catalogue`."""
        with open(path, "w" if replace else "x", encoding="utf-8") as file:
            file.write(self.to_toml())

    def plot(self) -> Figure:
        """Error on the validation recordings without and with each law. Needs Matplotlib."""
        from ._plots import of_candidates

        return of_candidates([law | {"effect": law["formula"], "cylinder": law["at"]} for law in self.laws])


class Refinement(_WithSignals, _WithModel):
    """A model with more effects, fitted and measured again. `model` is the refined one."""

    @property
    def verdict(self) -> str:
        """`adequate`, `missing_effect` or `unexplained`."""
        return self._content["verdict"]

    @property
    def steps(self) -> list[dict[str, Any]]:
        """What was added at each step, and the errors of the signals then."""
        return self._content["steps"]

    def _compared(self) -> list[str]:
        return list(self.steps[-1]["signals"])


class Design(Result):
    """A manoeuvre that separates effects, or shows a parameter."""

    @property
    def profile(self) -> str | None:
        """The profile file (TOML), for `Model.simulate` and the program; `None` where no manoeuvre is expected to be enough."""
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
    """Where the energy of a recording went, and whether the ledger of the model closes."""

    @property
    def closes(self) -> bool:
        """Whether noise explains the rest of every equation."""
        return self._content["ledger_closes"]

    @property
    def losses(self) -> dict[str, float]:
        """Energy that each effect took from the cylinders and the pump line, J."""
        effects = self._content["energy"]["effects"]
        # What is not known is None in JSON.
        taken = [-((one["into_cylinders"] or 0.0) + (one["into_pump_line"] or 0.0)) for one in effects]
        return {f"{one['effect']}@{one['at']}": energy for one, energy in zip(effects, taken, strict=True)}

    def plot(self) -> Figure:
        """Energy that each effect took, J. Needs Matplotlib."""
        from ._plots import of_bars

        return of_bars(self.losses, "energy, J")


class Characterisation(Result):
    """Valve and friction, read off recordings without a simulation."""

    @property
    def cylinders(self) -> dict[str, dict[str, Any]]:
        """What was found of each cylinder."""
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
