"""The full-order engine: finite elements of all bodies in time."""
