"""Strain that is not elastic, in cells below a free surface: the stress and displacement of a cell, and of all."""
