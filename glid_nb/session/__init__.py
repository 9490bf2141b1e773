"""Problems, poses and reports as values and files: between the numerics and a user interface."""

from glid_nb.session.json_file import InputFileError
from glid_nb.session.problem import Problem, load_pose
from glid_nb.session.report import build_report
from glid_nb.session.scribbles import load_scribbles
from glid_nb.session.suggest import suggest_pose

__all__ = [
    "InputFileError",
    "Problem",
    "build_report",
    "load_pose",
    "load_scribbles",
    "suggest_pose",
]
