"""Free rocking in this project's engines and in other programs, side by side; `python -m
benchmarks.peers`.
"""
