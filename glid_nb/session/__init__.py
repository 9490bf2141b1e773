"""Problems, poses and reports as values and files: between the numerics and a user interface."""

from glid_nb._errors import InputFileError as InputFileError
from glid_nb.session.autosave import Autosave as Autosave
from glid_nb.session.document import Document as Document
from glid_nb.session.document import DocumentError as DocumentError
from glid_nb.session.document import NamedPose as NamedPose
from glid_nb.session.document_file import load_document as load_document
from glid_nb.session.document_file import save_document as save_document
from glid_nb.session.problem import Problem as Problem
from glid_nb.session.problem import load_pose as load_pose
from glid_nb.session.report import build_report as build_report
from glid_nb.session.script import python_code as python_code
from glid_nb.session.suggest import suggest_pose as suggest_pose
from glid_nb.session.tracing import TracingModel as TracingModel
from glid_nb.session.tracing import TracingProblem as TracingProblem
