"""Files damaged in every way met so far, and whether each is used or refused in one line: see
`python -m benchmarks.fuzz --help`.

A subject is a module with

    prepare(folder)          makes the sound files, once a process
    sound(folder)            what `use` takes of the sound files, which is used
    mutate(rng, folder)      makes a mutant of them in a folder of its own, returns what `use` takes
    use(mutant)              does what a command would do with it
"""

SUBJECTS = ("cases", "studies", "motions", "ensembles", "folders", "calibrations", "classes")
