"""Every verification case holds in every engine."""

import pytest

from fecolumn.verification.suite import lines, run_case, tasks


@pytest.mark.verification
@pytest.mark.parametrize("case, engine", tasks())
def test_case_holds(case, engine):
    finding = run_case(case, engine)
    assert finding.ok, "\n" + lines(finding)
