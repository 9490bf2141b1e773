"""Files of problems, poses and documents, and what a script reads off them."""

from glid_nb.session.document import Document, NamedPose
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.problem import Problem, load_pose
from glid_nb.session.report import build_report
from glid_nb.session.script import python_code

__all__ = [
    "Document",
    "NamedPose",
    "Problem",
    "build_report",
    "load_document",
    "load_pose",
    "python_code",
    "save_document",
]
