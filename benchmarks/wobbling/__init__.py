"""The study of the wobbling model on a restrained frame: six bins of motions, their distributions,
and tests against experiments.
"""
