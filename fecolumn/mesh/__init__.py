"""Meshes of the specimen: column, cap plate and base plate from 8-node bricks, tied where they do not match."""

from fecolumn.mesh.bricks import BASE, CAP, LOWER, UPPER, BrickMesh
from fecolumn.mesh.specimen import SpecimenMesh, specimen_mesh
from fecolumn.mesh.tie import Tie

__all__ = ["BASE", "CAP", "LOWER", "UPPER", "BrickMesh", "SpecimenMesh", "Tie", "specimen_mesh"]
