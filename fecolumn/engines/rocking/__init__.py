"""Closed-form and rigid-body models of rocking: planar block, frame, and what overturns them.

`model` says what a model is, and holds their names; each model is a module of its own.
"""

from fecolumn.case.model_names import MODELS, model_class
from fecolumn.engines.rocking.model import ModelResponse

__all__ = ["MODELS", "ModelResponse", "model_class"]
