"""A half-space under loaded rectangles and discs: on its surface, inside it, after the load has passed."""
