"""From what a scanner wrote to the surface of a tread: files, pose, unit, faults, maps."""
