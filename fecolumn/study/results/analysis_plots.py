"""Figures of one analysis from its folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.foundation.files import is_file
from fecolumn.foundation.refused import UnknownName
from fecolumn.foundation.schema import InputError, meant
from fecolumn.study.results.picture import Picture


def history_of(folder: Path) -> dict[str, NDArray[Any]]:
    """Arrays of the history of an analysis by name.

    Raises
    ------
    InputError
        the analysis has written none yet, or it is damaged or of another case.
    """
    from fecolumn.engines.stored import stored_history

    file = folder / "history.h5"
    if not is_file(file):
        raise InputError(file, "", None, "not written yet")
    return stored_history(file)


class AnalysisPlots:
    """Figures of an analysis, each a Picture.

    Each raises an InputError where the analysis has written no history yet, or a damaged one.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def top(self) -> Picture:
        """Displacement of the top against time, below the ground motion."""
        from fecolumn.pictures.figures.history_curves import HistoryCurves, read_ending
        from fecolumn.pictures.figures.top_figure import top_figure

        return Picture(
            lambda path: top_figure(
                HistoryCurves.read(self.folder / "history.h5"), read_ending(self.folder), path
            )
        )

    def path(self) -> Picture:
        """Path of the top in plan."""
        from fecolumn.pictures.figures.history_curves import HistoryCurves, read_ending
        from fecolumn.pictures.figures.path_figure import path_figure

        return Picture(
            lambda path: path_figure(
                HistoryCurves.read(self.folder / "history.h5"), read_ending(self.folder), path
            )
        )

    def joints(self, *names: str) -> Picture:
        """Of a structure: tilt, uplift, slide and normal force at its joints.

        Parameters
        ----------
        names
            of joints, as in the case; none for all.

        Raises
        ------
        InputError
            there is no joint of this name, or none at all (a KeyError, too).
        """
        from fecolumn.pictures.figures.structure_figures import interface_figure, interface_names

        columns = history_of(self.folder)
        chosen = self._chosen(names, interface_names(columns), "joint")
        return Picture(lambda path: interface_figure(columns, path, chosen))

    def interfaces(self, *names: str) -> Picture:
        """Older name of `joints`."""
        warn_of_older_name("script", "plot.interfaces", "plot.joints")
        return self.joints(*names)

    def storeys(self) -> Picture:
        """Of a structure with storeys: their drifts and shears."""
        from fecolumn.pictures.figures.structure_figures import storey_figure

        return Picture(lambda path: storey_figure(history_of(self.folder), path))

    def links(self, *names: str) -> Picture:
        """Of a structure with links: their tension over time and over their elongation.

        Parameters
        ----------
        names
            of links, as in the case, whose copies go by one name; none for all.

        Raises
        ------
        InputError
            there is no link of this name, or none at all (a KeyError, too).
        """
        from fecolumn.pictures.figures.structure_figures import link_figure, link_names

        columns = history_of(self.folder)
        chosen = self._chosen(names, link_names(columns), "link")
        return Picture(lambda path: link_figure(columns, path, chosen))

    def bonds(self, *names: str) -> Picture:
        """Of a structure with glued joints: their stresses and how much of them has failed.

        Parameters
        ----------
        names
            of joints, as in the case, or of one of their places such as "foot: vase on ground", as
            in the history; none for all.

        Raises
        ------
        InputError
            there is no glued joint of this name, or none at all (a KeyError, too).
        """
        from fecolumn.pictures.figures.structure_figures import bond_figure, bond_names

        columns = history_of(self.folder)
        places: dict[str, list[str]] = {}
        for bond in bond_names(columns):
            places.setdefault(bond.partition(":")[0], []).append(bond)
        whole = {bond: [bond] for bonds in places.values() for bond in bonds}
        known = list(places)
        if any(name not in whole for name in names) or not names:
            self._chosen([name for name in names if name not in whole], known, "glued joint")
        found = [bond for name in names or known for bond in (whole | places)[name]]
        return Picture(lambda path: bond_figure(columns, path, list(dict.fromkeys(found))))

    def energy(self) -> Picture:
        """The energy ledger against time."""
        from fecolumn.pictures.figures.energy_figure import energy_figure
        from fecolumn.pictures.figures.history_curves import HistoryCurves

        return Picture(
            lambda path: energy_figure(HistoryCurves.read(self.folder / "history.h5"), path)
        )

    def _chosen(self, names: Sequence[str], known: list[str], what: str) -> list[str]:
        """The names that a figure is to show, all unless some are given.

        Raises
        ------
        UnknownName
            none of this name, or none at all.
        """
        if not known:
            raise UnknownName(self.folder, "", None, f"this analysis has no {what}")
        for name in names:
            if name not in known:
                told = f"no {what} {name!r}{meant(name, known)}; known: {', '.join(known)}"
                raise UnknownName(self.folder, "", None, told)
        return list(names) or known
