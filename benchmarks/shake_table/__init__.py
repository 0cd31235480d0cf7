"""Shake-table tests of a granite rock against a rigid body from its scan, with nothing fitted to
the outcomes.
"""
