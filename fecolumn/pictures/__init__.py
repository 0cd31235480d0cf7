"""Figures, movies and files for ParaView."""
