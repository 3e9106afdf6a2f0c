"""Pressure and shear of bodies whose influence is known."""
