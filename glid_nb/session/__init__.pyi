from .deformation import Deformation as Deformation
from .tracing import TracingModel as TracingModel
