"""Finite elements: bodies, their matrices and modes, factors, strain and damping."""
