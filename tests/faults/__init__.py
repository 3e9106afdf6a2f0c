"""Full disks, read-only folders, files that change while they are read, and kills; see `python -m faults`."""
