"""Layers on a half-space: per wavenumber, gathered again on grids, discs and under moving loads."""
