"""Studies that take motions until their question is decided."""
