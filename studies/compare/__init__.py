"""The other methods on the same problems, and the paper's figures and tables reproduced."""

from studies.compare import (
    folding,
    hessian_samples,
    iteration_times,
    landmarks,
    lipschitz,
    maps,
    progress,
)

STUDIES = (
    progress.STUDY,
    iteration_times.STUDY,
    maps.BOUNDED,
    maps.CONFORMAL,
    maps.EXPONENTIAL,
    lipschitz.STUDY,
    hessian_samples.STUDY,
    folding.STUDY,
    landmarks.STUDY,
)
