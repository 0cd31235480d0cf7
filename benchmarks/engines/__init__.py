"""The reduced engine against the full-order one: physics, convergence, standing still, speed.

See __main__.
"""
