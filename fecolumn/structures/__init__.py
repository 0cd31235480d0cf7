"""Structures of many bodies: frames, stacks, podia and blocks that rock, slide and wobble on one
another.
"""
