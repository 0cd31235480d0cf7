"""Constitutive laws of the bodies' materials."""
