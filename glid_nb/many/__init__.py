"""Many problems on many processes and machines: `solve_many` over any executor."""

from glid_nb.many.answer import ProblemError as ProblemError
from glid_nb.many.pool import ExecutorLostError as ExecutorLostError
from glid_nb.many.solve_many import Solved as Solved
from glid_nb.many.solve_many import solve_many as solve_many
