"""The solver on a GPU and on the CPU of the same machine, within a few minutes.

Each part runs in one process per platform, which prints its results line by line. A process that
takes longer than its share of the time is stopped, and its results so far are kept.
"""
