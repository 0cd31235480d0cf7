"""Results of benchmarks kept one a file: what is there is not made again, of older physics none."""

import json

import pytest

from benchmarks import kept


def test_what_is_there_is_not_made_again_and_what_is_missing_is(tmp_path):
    jobs = {tmp_path / "parts" / f"{number}.json": (number,) for number in range(4)}
    made = []

    def square(number):
        made.append(number)
        return number**2

    kept.complete(square, dict(list(jobs.items())[:2]), 1, "squares")
    kept.complete(square, jobs, 1, "squares")
    assert sorted(made) == [0, 1, 2, 3] and kept.found(jobs) == [0, 1, 4, 9]


def test_results_of_older_physics_are_refused(tmp_path, monkeypatch):
    jobs = {tmp_path / "1.json": (1,)}
    kept.complete(float, jobs, 1, "numbers")
    assert json.loads((tmp_path / "settings.json").read_text()) == {"physics": kept.PHYSICS}
    older = kept.PHYSICS
    monkeypatch.setattr(kept, "PHYSICS", older + 1)
    with pytest.raises(
        SystemExit, match=f"holds results with physics {older}: choose another folder by -o"
    ):
        kept.complete(float, jobs, 1, "numbers")
