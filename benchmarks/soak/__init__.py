"""Very many analyses of drawn cases, by a study driver and workers that are killed every few
minutes: see `python -m benchmarks.soak --help`.

hypercube    Latin hypercubes, their samples by the names of what is drawn
specimens    tubes, drums and blocks on plates, flats and pads
motions      ground motions of every family that needs no download
cases        the analyses, in blocks, each a study of its own
analysis     an analysis and what its process held afterwards
drive        the process that drives the blocks
watch        starts the driver, kills it and its workers, looks at its memory
report       what came of it: failures, histograms, growth, and the worst cases with files to
    run them again
"""
