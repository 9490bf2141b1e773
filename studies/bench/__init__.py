"""How fast the solver is on this machine."""

from studies.bench import batches, many, scaling, solving, starting

STUDIES = (solving.STUDY, starting.STUDY, scaling.STUDY, batches.STUDY, many.STUDY)
