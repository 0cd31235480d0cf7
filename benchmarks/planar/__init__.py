"""A planar program of rigid polygons with Coulomb's friction and plastic impacts (Moreau 1988, Jean
1999), which judges the package; `python -m benchmarks.planar`.

`bodies`, `contact`, `nsgs`, `advance`, `structures` and `theory` share no code with the package.
"""
