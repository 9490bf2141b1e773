"""The verdicts on an exercise, and on a notebook that is not graded."""

RIGHT, WRONG, UNTOUCHED, MISSING = "right", "wrong", "untouched", "missing"
CRASHED, SLOW = "crashed", "too slow"
LEFT_OUT = "left out"
ALL = RIGHT, WRONG, UNTOUCHED, MISSING, CRASHED, SLOW, LEFT_OUT
