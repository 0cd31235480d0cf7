"""Closed-form and rigid-body models of rocking: planar block, frame, and what overturns them.

`model` says what a model is, and holds their names; each model is a module of its own.
"""

from fecolumn.engines.rocking.model import MODELS, ModelResponse, model_class

__all__ = ["MODELS", "ModelResponse", "model_class"]
