"""Closed-form and rigid-body models of rocking: planar block, frame, and what overturns them.

`model` says what a model is, `models` holds them by name; each is a module of its own.
"""
