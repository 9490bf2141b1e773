"""The verdicts on an exercise."""

RIGHT, WRONG, UNTOUCHED, MISSING = "right", "wrong", "untouched", "missing"
CRASHED, SLOW = "crashed", "too slow"
ALL = RIGHT, WRONG, UNTOUCHED, MISSING, CRASHED, SLOW
