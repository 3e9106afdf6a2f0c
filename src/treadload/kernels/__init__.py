"""Arrays in, arrays out: numerical kernels that know no tire and no road."""
