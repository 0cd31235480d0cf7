"""Results read back into Python: an analysis or a study, its arrays, tables and figures."""
