"""The verbs of the program as functions.

Common options:

- `accept`: names of checks to overrule, as given in the error of a check that rejects a recording;
- `where`: conditions such as `"abs(v) > 0.002"`; a recording is compared with the model only where all of them hold;
- `whole`: use all of a recording longer than three minutes, not only its most informative stretches;
- `progress`: `True` for a progress line on standard error, or a function that is called with the current step and the fraction done (0 to 1).
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

    `against` is a second model, compared with the same recording. `repeat` is another run with the same commands; it shows the
    repeatability of the machine.
    """
    other = None if against is None else against._native
    again = None if repeat is None else repeat._native
    found = _native.compare(model._native, recording._native, other, again, _usage(accept, where, whole))
    return Comparison(_told(found))


def identify(
    model: Model,
    recordings: Recordings,
    *,
    method: str = "best",
    accept: str | Sequence[str] = (),
    where: Where = (),
    whole: bool = False,
) -> Identification:
    """Identifies the unknown parameters of `model`.

    `method` is `weak-form` (not biased by sensor noise), `least-squares` (smoothed differences; biased by noise), `output-error` (weak
    form, followed by a fit of simulated outputs over short segments), `simulation-error` (the same from measured states) or `best`: the
    one of the three others than least squares that predicts the last third of the recordings best from the rest.
    """
    return Identification(_told(_native.identify(model._native, _all(recordings), method, _usage(accept, where, whole))))


def characterise(
    model: Model, recordings: Recordings, *, accept: str | Sequence[str] = (), where: Where = ()
) -> Characterisation:
    """Determines valve and friction properties without a simulation: gains, dead zone, hysteresis, leakage, and friction against speed."""
    return Characterisation(_told(_native.characterise(model._native, _all(recordings), _usage(accept, where, True))))


def energy(model: Model, recording: Recording, *, accept: str | Sequence[str] = (), where: Where = ()) -> Energy:
    """Computes where the energy of a recording went, and whether the energy ledger of the model closes."""
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
    """Determines which physical effect `model` is missing.

    Parameters are fitted to the `identification` recordings. Evidence comes from the `validation` recordings, which are never fitted.
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
    """Proposes laws, as formulas, for effects that `model` is missing and that no catalogue contains."""
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
    """Adds effects to the model, fits it again, and computes the new errors.

    `add` names the effects (`"pump_leakage"`, `"seal_friction@load"`). By default, a diagnosis selects them; with `laws=True` it may also
    propose laws that no catalogue contains.
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
    """Designs a manoeuvre that separates the effects `between` (`"none"` is the unchanged model), or that makes a `parameter` identifiable.

    `diagnosis` is a result of `diagnose`, or a file from `excavator diagnose --json`. It supplies tied effects, fitted values and sensor
    noise. The profile lasts at most `duration` (s), keeps the fraction `stroke_margin` of the stroke free at each end, and stays below
    `highest_pressure` (Pa).
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
