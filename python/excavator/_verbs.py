"""The verbs of the program as functions.

Options that several of them have:

- `accept`: names of checks that may refuse a recording and are overruled, as a refusal says them;
- `where`: conditions such as `"abs(v) > 0.002"`; a recording is compared with the model only where all of them hold;
- `whole`: use all of a recording of more than three minutes, not only its most informative stretches;
- `progress`: `True` for a line on standard error, or a function that is called with what is done and the fraction done (0 to 1).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

from . import _native
from ._errors import remark
from ._model import Model
from ._progress import teller
from ._recording import Path, Recording
from ._results import (
    Characterisation,
    Comparison,
    Design,
    Diagnosis,
    Energy,
    Identification,
    Proposals,
    Refinement,
)

Recordings = Recording | Sequence[Recording]
Progress = bool | Callable[[str, float], object] | None
Where = str | Sequence[str]


def compare(
    model: Model,
    recording: Recording,
    *,
    against: Model | None = None,
    repeat: Recording | None = None,
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Comparison:
    """Simulates `model` with the input of `recording` and compares every output with the measurement.

    `against` is another model for the same recording. `repeat` is another run of the same commands; it shows how well the machine repeats
    itself.
    """
    other = None if against is None else against._native
    again = None if repeat is None else repeat._native
    found = _native.compare(model._native, recording._native, other, again, _usage(accept, where, whole))
    return Comparison(_told(found))


def identify(
    model: Model,
    recordings: Recordings,
    *,
    method: str = "weak-form",
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Identification:
    """Identifies the unknown parameters of `model`.

    `method` is `weak-form` (not biased by sensor noise), `least-squares` (smoothed differences; biased by noise) or `output-error` (weak
    form, then simulated outputs fitted to the measured ones).
    """
    return Identification(_told(_native.identify(model._native, _all(recordings), method, _usage(accept, where, whole))))


def characterise(
    model: Model, recordings: Recordings, *, accept: str | Sequence[str] = (), where: Where = ()
) -> Characterisation:
    """Reads valve and friction off recordings without a simulation: gains, dead zone and hysteresis, leakage, friction against speed."""
    return Characterisation(_told(_native.characterise(model._native, _all(recordings), _usage(accept, where, True))))


def energy(model: Model, recording: Recording, *, accept: str | Sequence[str] = (), where: Where = ()) -> Energy:
    """Where the energy went, and whether the ledger of the model closes."""
    return Energy(_told(_native.energy(model._native, recording._native, _usage(accept, where, True))))


def diagnose(
    model: Model,
    identification: Recordings,
    validation: Recordings,
    *,
    progress: Progress = None,
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Diagnosis:
    """Finds out which physical effect `model` is missing.

    Parameters are fitted to the recordings `identification`. Evidence comes from the recordings `validation`, which are never fitted.
    """
    usage = _usage(accept, where, whole)
    with teller(progress) as tell:
        found = _native.diagnose(model._native, _all(identification), _all(validation), usage, tell)
    return Diagnosis(_told(found))


def propose(
    model: Model,
    identification: Recordings,
    validation: Recordings,
    *,
    progress: Progress = None,
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Proposals:
    """Proposes laws, as formulas, for what `model` is missing and no catalogue has."""
    usage = _usage(accept, where, whole)
    with teller(progress) as tell:
        found = _native.propose(model._native, _all(identification), _all(validation), usage, tell)
    return Proposals(_told(found))


def refine(
    model: Model,
    identification: Recordings,
    validation: Recordings,
    *,
    add: str | Sequence[str] = (),
    laws: bool = False,
    progress: Progress = None,
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Refinement:
    """Adds effects, fits the model again, and measures the error again.

    `add` names the effects (`"pump_leakage"`, `"seal_friction@load"`). Without, a diagnosis finds them; with `laws=True` it may also propose
    laws that no catalogue has.
    """
    names, usage = _listed(add), _usage(accept, where, whole)
    with teller(progress) as tell:
        found = _native.refine(model._native, _all(identification), _all(validation), names, laws, usage, tell)
    return Refinement(_told(found))


def design(
    model: Model,
    *,
    between: str | Sequence[str] = (),
    parameter: str | None = None,
    diagnosis: Diagnosis | Path | None = None,
    duration: float = 60.0,
    stroke_margin: float = 0.08,
    highest_pressure: float = 20e6,
    progress: Progress = None,
) -> Design:
    """Designs a manoeuvre that separates the effects `between` (`"none"` is the model as it is), or that shows a `parameter`.

    `diagnosis` is a result of `diagnose`, or a file of `excavator diagnose --json`: tied effects, fitted values and the noise of the sensors
    are taken from there. The profile lasts `duration` (s) at most, keeps the share `stroke_margin` of the stroke free at each end, and stays
    below `highest_pressure` (Pa).
    """
    is_file = isinstance(diagnosis, (str, os.PathLike))
    order = {
        "between": _listed(between),
        "parameter": parameter,
        "diagnosis_file": diagnosis if is_file else None,
        "diagnosis_text": diagnosis.to_json() if isinstance(diagnosis, Diagnosis) else None,
        "duration": float(duration),
        "stroke_margin": float(stroke_margin),
        "highest_pressure": float(highest_pressure),
    }
    with teller(progress) as tell:
        return Design(_native.design(model._native, order, tell))


def _usage(accept: str | Sequence[str], where: Where, whole: bool) -> dict[str, object]:
    return {"accept": _listed(accept), "conditions": _listed(where), "whole": whole}


def _listed(given: str | Sequence[str]) -> list[str]:
    return [given] if isinstance(given, str) else list(given)


def _all(recordings: Recordings) -> list[_native.Recording]:
    several = [recordings] if isinstance(recordings, Recording) else recordings
    return [one._native for one in several]


def _told(found: tuple[_native.Outcome, list[str]]) -> _native.Outcome:
    outcome, remarks = found
    remark(remarks, depth=4)
    return outcome
