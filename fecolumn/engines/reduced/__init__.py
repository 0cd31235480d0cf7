"""The reduced engine: a floating frame, elastic modes and the exact static compliance of the same
finite elements.
"""
