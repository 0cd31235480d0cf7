"""Distribution functions, two-sample tests, fragility curves and regressions of peaks."""
