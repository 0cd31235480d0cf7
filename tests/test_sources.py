"""Every result says which code made it, and code that differs is not mixed unseen."""

import shutil

import numpy as np
import pytest
from imported_modules import ROOT, closure

from fecolumn import __version__
from fecolumn.case.case import case_from_tables
from fecolumn.engines.summary import write_sealed
from fecolumn.foundation import sources
from fecolumn.simulation import run

# Modules that an analysis imports and that decide nothing of its result: they read, write, wait,
# compile and tell
_DECIDE_NOTHING = {
    "foundation/_borrowed.py",
    "foundation/_compiled.py",
    "foundation/_form_compiler.py",
    "foundation/_kernel.py",
    "foundation/arrays.py",
    "foundation/atomic.py",
    "foundation/cores.py",
    "foundation/deprecated.py",
    "foundation/digests.py",
    "foundation/files.py",
    "foundation/lock.py",
    "foundation/paths.py",
    "foundation/progress.py",
    "foundation/refused.py",
    "foundation/schema.py",
    "foundation/section_class.py",
    "case/case_text.py",
    "foundation/sealed.py",
    "foundation/sources.py",
    "foundation/toml_file.py",
    "foundation/version.py",
    "simulation.py",
}
_BLOCK = dict(
    column=dict(shape="block", length_m=0.4, width_m=0.4, height_m=1.2),
    initial=dict(tilt_rad=0.01),
    mesh=dict(fine_size_m=0.1, coarse_size_m=0.2, base_size_m=0.2),
    integration=dict(engine="rigid", duration_s=0.01),
)


@pytest.fixture
def block():
    return case_from_tables(_BLOCK, "block")


@pytest.mark.long
def test_digest_covers_all_that_an_analysis_imports_but_what_decides_nothing():
    covered = {str(path.relative_to(ROOT)) for path in sources.files_of(sources.DECIDING)}
    assert closure("simulation.py") - covered == _DECIDE_NOTHING


def test_digest_changes_with_a_source_and_not_with_the_manual(tmp_path, monkeypatch):
    shutil.copytree(ROOT, tmp_path / "fecolumn", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(sources, "_PACKAGE", tmp_path / "fecolumn")

    def digest():
        return sources.package_digest.__wrapped__()

    assert digest() == sources.package_digest()
    (tmp_path / "fecolumn" / "case" / "manual" / "theory.md").write_text("")
    assert digest() == sources.package_digest()
    with open(tmp_path / "fecolumn" / "contact" / "friction.py", "a") as file:
        file.write("\n")
    assert digest() != sources.package_digest()


def test_source_that_is_no_longer_there_is_an_error():
    with pytest.raises(FileNotFoundError, match="fem/gone.py"):
        sources.files_of(["simulation.py", "fem/gone.py"])


def test_summary_states_version_and_sources(block, tmp_path):
    summary = run(block, tmp_path / "out", quiet=True)
    assert (summary["version"], summary["sources"]) == (__version__, sources.package_digest())


def test_result_of_other_code_is_kept_and_told(block, tmp_path):
    summary = run(block, tmp_path / "out", quiet=True)
    write_sealed(tmp_path / "out", summary | {"sources": "0123456789abcdef"})
    with pytest.warns(
        UserWarning,
        match=r"holds the result of other code, fecolumn .* \(sources 0123456789abcdef\), "
        r"which is kept",
    ):
        assert run(block, tmp_path / "out", quiet=True)["sources"] == "0123456789abcdef"


def test_result_that_goes_on_from_other_codes_checkpoint_is_of_both(block, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        run(
            case_from_tables(
                _BLOCK | {"integration": {"engine": "rigid", "duration_s": 0.6}}, "block"
            ),
            tmp_path / "out",
            quiet=True,
            stop=lambda: True,
        )
    file = tmp_path / "out" / "checkpoint.npz"
    with np.load(file) as saved:
        arrays = {name: saved[name] for name in saved.files}
    np.savez(file, **arrays | {"sources": "0123456789abcdef"})
    case = case_from_tables(
        _BLOCK | {"integration": {"engine": "rigid", "duration_s": 0.6}}, "block"
    )
    with pytest.warns(UserWarning, match="is of other code, .*sources 0123456789abcdef"):
        summary = run(case, tmp_path / "out", quiet=True)
    assert summary["sources"] == f"0123456789abcdef+{sources.package_digest()}"
