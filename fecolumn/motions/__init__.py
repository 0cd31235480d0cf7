"""Ground motions: recorded acceleration histories, read, checked, and brought to the step of the
analysis.
"""
