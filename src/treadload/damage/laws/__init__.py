"""Allowable load repetitions of a strain, a stress or a bond."""
