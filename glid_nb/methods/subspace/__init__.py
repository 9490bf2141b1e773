"""Methods in the harmonic subspace, with the line search and certificate of our Newton method."""
