"""Figures of studies of many cases."""
