"""Distributions of one ensemble by several programs: the same four structures under the same 115
motions in MuJoCo, Siconos, the planar program of this repository and fecolumn; `python -m
benchmarks.programs`.
"""
