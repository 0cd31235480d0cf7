"""Figures of results, and the fields of a body at chosen times."""
