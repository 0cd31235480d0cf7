"""Links by their kind for a script: each is a Link whose `kind` is set."""

from __future__ import annotations

from fecolumn.case.link import Link
from fecolumn.foundation.schema import parameter
from fecolumn.foundation.section_class import section_class

_DOC = "what the link is"


@section_class()
class Tendon(Link):
    """A tendon or wire: only pulls, beyond slack_m; needs stiffness_n_m."""

    kind: str = parameter("tendon", doc=_DOC, choices=("tendon",))


@section_class()
class Spring(Link):
    """A spring or bar: pulls and pushes, and yields where yield_n is given; needs
    stiffness_n_m.
    """

    kind: str = parameter("spring", doc=_DOC, choices=("spring",))


@section_class()
class Restrainer(Link):
    """A restrainer: pulls and pushes beyond slack_m to each side; needs stiffness_n_m."""

    kind: str = parameter("restrainer", doc=_DOC, choices=("restrainer",))


@section_class()
class Strut(Link):
    """A strut: only pushes; needs stiffness_n_m."""

    kind: str = parameter("strut", doc=_DOC, choices=("strut",))


@section_class()
class GapStop(Link):
    """A stop: only pushes, beyond gap_m; needs stiffness_n_m."""

    kind: str = parameter("stop", doc=_DOC, choices=("stop",))


@section_class()
class Dashpot(Link):
    """A viscous damper, c |v|^a sign(v); needs damping_n_s_m."""

    kind: str = parameter("dashpot", doc=_DOC, choices=("dashpot",))


@section_class()
class FrictionDamper(Link):
    """A friction damper, elastic until it slips at slip_n; needs stiffness_n_m, too."""

    kind: str = parameter("friction", doc=_DOC, choices=("friction",))
