"""Grading of handed-in chapters: `glid-nb grade`.

`chapters` reads notebooks, and `handed_in` finds those that count in a folder. `grade` runs a
referee for each of them, and `said` reads its verdicts. `tables` writes them. A *referee*
(`referee`) is a process that runs the course's own cells and checks. The answers run in a second
process (`student`), and only values that `wire` can write as JSON come back from there.
"""
