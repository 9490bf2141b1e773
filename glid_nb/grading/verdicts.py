"""The verdicts on an exercise."""

RIGHT, WRONG, UNTOUCHED, CRASHED, SLOW = "right", "wrong", "untouched", "crashed", "too slow"
