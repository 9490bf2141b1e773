"""What a worker does with a problem. It runs in a process of this or another machine."""

import pickle
import threading
import uuid
import zlib
from collections import OrderedDict
from typing import Any

from glid_nb._runtime import enable_compilation_cache
from glid_nb.many import answer
from glid_nb.many.plan import Plan
from glid_nb.minima import solve
from glid_nb.pose import Pose

HERE = uuid.uuid4().hex
"""This process. A worker with another value keeps compiled programs on its disk."""

NO_PLAN = b"no plan"
"""The answer of a worker that has not got the plan yet."""

# A process keeps the matrices of the last 8 domains (`discretise`), so more plans save little.
_MOST_PLANS = 8
_plans = OrderedDict[str, Plan]()
_lock = threading.Lock()  # a worker may have several threads


def work(plan_key: str, plan: Any, pose: bytes, sender: str) -> bytes:
    """Solve a problem. ``plan`` is None if this worker should know it by its key.

    Returns an answer (:mod:`glid_nb.many.answer`), also for a problem that raises.
    """
    if (known := _known(plan_key, plan)) is None:
        return NO_PLAN
    if sender != HERE:
        enable_compilation_cache()
    problem = unpacked(pose)
    key = known.problem_key(problem)
    try:
        inputs = known.domain, problem, known.energy, known.options
        return answer.of_result(solve(*inputs, method=known.method), key)
    except Exception as error:  # the others go on
        return answer.of_error(error, key)


def packed(pose: Pose) -> bytes:
    """A pose for the way to a worker."""
    return zlib.compress(pickle.dumps(pose, protocol=5))


def unpacked(data: bytes) -> Pose:
    return pickle.loads(zlib.decompress(data))


def _known(key: str, plan: Any) -> Plan | None:
    """The worker's copy of a plan. All its poses share the matrices, found by the domain."""
    with _lock:
        if key not in _plans:
            if plan is None:
                return None
            _plans[key] = pickle.loads(plan) if isinstance(plan, bytes) else plan
        _plans.move_to_end(key)
        while len(_plans) > _MOST_PLANS:
            _plans.popitem(last=False)
        return _plans[key]
