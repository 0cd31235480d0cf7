"""Analyses: in full order, reduced, rigid, and rocking models."""
