"""Meshes of the specimen: column, flange, cap plate and base plate, tied where they do not
match.
"""
