"""Standard gravity."""

#: [m/s2] (3rd General Conference on Weights and Measures 1901)
GRAVITY = 9.80665
