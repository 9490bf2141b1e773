"""Methods in the harmonic subspace, with Newton's own line search and certificate."""
