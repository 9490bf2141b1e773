"""How fast the solver is on this machine."""

from studies.bench import batches, scaling, solving, starting

STUDIES = (solving.STUDY, starting.STUDY, scaling.STUDY, batches.STUDY)
