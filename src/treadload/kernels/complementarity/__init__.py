"""Pressure that does not pull and shear that friction bounds: the solvers of both problems."""
