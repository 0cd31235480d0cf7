"""The rocking models by their words of integration.engine."""

from __future__ import annotations

from fecolumn.engines.rocking.block import RockingBlock
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.model import Model
from fecolumn.engines.rocking.podium import Podium
from fecolumn.engines.rocking.wobbling import Wobbling
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame

ROCKING_MODELS: dict[str, type[Model]] = {
    "housner": RockingBlock,
    "rocking_frame": RockingFrame,
    "wobbling": Wobbling,
    "wobbling_frame": WobblingFrame,
    "podium": Podium,
}
