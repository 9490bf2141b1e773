"""Problems, poses and reports as values and files: between the numerics and a user interface."""

from glid_nb._errors import InputFileError
from glid_nb.session.autosave import Autosave
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.problem import Problem, load_pose
from glid_nb.session.report import build_report
from glid_nb.session.script import python_code
from glid_nb.session.suggest import suggest_pose
from glid_nb.session.tracing import TracingModel, TracingProblem

__all__ = [
    "Autosave",
    "Document",
    "DocumentError",
    "InputFileError",
    "NamedPose",
    "Problem",
    "TracingModel",
    "TracingProblem",
    "build_report",
    "load_document",
    "load_pose",
    "python_code",
    "save_document",
    "suggest_pose",
]
