"""The solver on a GPU beside the CPU of the same machine, within a few minutes.

Each part runs in processes of its own, one per platform, which print what they find line by line.
A process that takes longer than its share of the time is stopped, and what it has found is kept.
"""
