"""Processes at a time are as many as there are cores for them."""

import os

from fecolumn.foundation.cores import usable_cores


def test_cores_are_those_that_the_process_may_use(tmp_path):
    quota, cores = tmp_path / "cpu.max", len(os.sched_getaffinity(0))
    assert usable_cores(tmp_path / "none") == cores
    for text, wanted in (
        ("max 100000", cores),
        ("50000 100000", 1),
        ("900000 100000", min(9, cores)),
    ):
        quota.write_text(text + "\n")
        assert usable_cores(quota) == wanted
