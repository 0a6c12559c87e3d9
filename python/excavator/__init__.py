"""Which physics is your hydraulic arm's model missing?

Recordings and bags as NumPy arrays, models of hydraulic machines, and the verbs of the program `excavator` as functions::

    import excavator

    rec = excavator.read("my-bag")
    model = excavator.Model.load("zx30u-arm")
    excavator.compare(model, rec)

All quantities are in SI units; pressures are gauge pressures.
"""

from ._bag import Bag, Topic
from ._errors import CheckError, ComputationError, ExcavatorError, ModelError, ReadError, Remark
from ._law import law, root, table
from ._model import Effect, Model, Parameter
from ._native import __version__
from ._recording import Recording, guess_map, read
from ._results import (
    Characterisation,
    Comparison,
    Design,
    Diagnosis,
    Energy,
    Identification,
    Proposals,
    Refinement,
    Result,
)
from ._verbs import characterise, compare, design, diagnose, energy, identify, propose, refine

__all__ = [
    "Bag",
    "Characterisation",
    "CheckError",
    "Comparison",
    "ComputationError",
    "Design",
    "Diagnosis",
    "Effect",
    "Energy",
    "ExcavatorError",
    "Identification",
    "Model",
    "ModelError",
    "Parameter",
    "Proposals",
    "ReadError",
    "Recording",
    "Refinement",
    "Remark",
    "Result",
    "Topic",
    "__version__",
    "characterise",
    "compare",
    "design",
    "diagnose",
    "energy",
    "guess_map",
    "identify",
    "law",
    "propose",
    "read",
    "refine",
    "root",
    "table",
]
