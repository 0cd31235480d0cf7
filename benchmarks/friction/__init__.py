"""The contact solver on friction problems of many bodies, beside Siconos; `python -m
benchmarks.friction`.
"""
