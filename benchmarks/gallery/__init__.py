"""The figures of README and manual, made again from what is in the repository."""
