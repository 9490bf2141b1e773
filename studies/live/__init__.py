"""The live page: its solver's times, and recorded drags in a browser."""

from studies.live import recorded, timings

STUDIES = (timings.STUDY, recorded.STUDY)
