"""From cells to points: convolution on the lattice, interpolation off it, sums where points are few."""
