"""Grading of handed-in chapters: `glid-nb grade`.

`chapters` reads notebooks, `handed_in` finds those that count in a folder, `grade` runs a referee
for each of them, `said` reads what it says, and `tables` writes that. A *referee* (`referee`) is a process that runs the
course's own cells and checks. The answers run in a second process (`student`), and only values
that `wire` can write as JSON come back from there.
"""
