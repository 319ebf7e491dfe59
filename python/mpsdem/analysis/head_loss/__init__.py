"""What pumping solids costs: models of the loss of pressure in pipes, and where each holds."""

from mpsdem.analysis.head_loss.conveying import (
    Conveying,
    Model,
    Range,
    hydraulic_gradient,
    inclined_gradient,
)
from mpsdem.analysis.head_loss.dhlldv import DHLLDV
from mpsdem.analysis.head_loss.durand import DURAND_CONDOLIOS
from mpsdem.analysis.head_loss.measured import Measured, comparable, measured
from mpsdem.analysis.head_loss.newitt import NEWITT
from mpsdem.analysis.head_loss.wilson import WILSON_STRATIFIED

MODELS = (DHLLDV, WILSON_STRATIFIED, NEWITT, DURAND_CONDOLIOS)
"""All models of the loss of pressure in a level pipe."""

__all__ = [
    "DHLLDV",
    "DURAND_CONDOLIOS",
    "MODELS",
    "NEWITT",
    "WILSON_STRATIFIED",
    "Conveying",
    "Measured",
    "Model",
    "Range",
    "comparable",
    "hydraulic_gradient",
    "inclined_gradient",
    "measured",
]
