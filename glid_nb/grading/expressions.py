"""Functions that JAX traces, such as energies, as lists of elementary operations.

JAX differentiates these in the referee, so calling them from afar is not enough. Only arithmetic on
single numbers can be sent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from glid_nb._jax import jax, jnp, lax
from glid_nb.grading.wire import WireError

_OTHER_NAMES = {"and": "bitwise_and", "or": "bitwise_or", "not": "bitwise_not", "add_any": "add"}
_SAME = ("convert_element_type", "copy", "copy_p", "stop_gradient", "reduce_precision")
_NAMES = """
    add sub mul div neg abs sign max min clamp floor ceil exp exp2 log log1p expm1 sqrt rsqrt cbrt
    pow square sin cos tan sinh cosh tanh asin acos atan atan2 logistic gt lt ge le eq ne select_n
    is_finite bitwise_and bitwise_or bitwise_not
"""
_OPERATIONS = frozenset(_NAMES.split())


def expression_of(function: Callable[..., Any], count: int) -> dict[str, Any]:
    """The operations of a function of ``count`` numbers. Raises a WireError."""
    with jax.enable_x64(True):
        traced = jax.make_jaxpr(function)(*np.ones(count))
    steps = list[dict[str, Any]]()
    inputs = [{"variable": i} for i in range(count)]
    constants = [_constant(value) for value in traced.consts]
    result = _inlined(traced.jaxpr, [*constants, *inputs], steps, count)
    if len(result) != 1:
        raise WireError(f"the function returns {len(result)} values instead of one")
    return {"steps": steps, "result": result[0]}


def _inlined(jaxpr: Any, inputs: Sequence[Any], steps: list[Any], count: int) -> list[Any]:
    known = dict(zip([*jaxpr.constvars, *jaxpr.invars], inputs, strict=True))

    def operand(atom: Any) -> Any:
        return _constant(atom.val) if hasattr(atom, "val") else known[atom]

    for eqn in jaxpr.eqns:
        operands = [operand(atom) for atom in eqn.invars]
        inner = eqn.params.get("jaxpr") or eqn.params.get("call_jaxpr")
        if inner is not None:
            closed = getattr(inner, "consts", ())
            body = getattr(inner, "jaxpr", inner)
            given = [*map(_constant, closed), *operands]
            results = _inlined(body, given, steps, count)
        else:
            name = eqn.primitive.name
            power = int(eqn.params["y"]) if name == "integer_pow" else None
            results = [{"variable": count + len(steps)}]
            steps.append({"name": name, "power": power, "operands": operands})
        known.update(zip(eqn.outvars, results, strict=True))
    return [operand(atom) for atom in jaxpr.outvars]


def _constant(value: Any) -> Any:
    if np.ndim(value):
        raise WireError("a function of an energy computes with single numbers, not with arrays")
    return {"constant": np.asarray(value).item()}


def evaluated(expression: Any, arguments: Sequence[Any]) -> Any:
    """The expression's value, in operations that JAX can trace. Raises a WireError."""
    values = list(arguments)

    def operand(data: Any) -> Any:
        if "variable" in data:
            return values[int(data["variable"])]
        constant = data["constant"]
        if not isinstance(constant, bool | int | float):
            raise WireError("a constant is a number")
        return constant

    for step in expression["steps"]:
        operands = [operand(data) for data in step["operands"]]
        name = _OTHER_NAMES.get(step["name"], step["name"])
        if name == "integer_pow":
            values.append(lax.integer_pow(jnp.asarray(operands[0]), int(step["power"])))
        elif name in _SAME:
            values.append(operands[0])
        elif name in _OPERATIONS:
            values.append(_operated(name, operands))
        else:
            raise WireError(f"the operation {name!r:.40} cannot be checked from afar")
    return operand(expression["result"])


def _operated(name: str, operands: Sequence[Any]) -> Any:
    arrays = [jnp.asarray(one) for one in operands]
    numbers = [one for one in arrays if one.dtype != bool]
    if numbers and name not in ("bitwise_and", "bitwise_or", "bitwise_not"):
        common = jnp.result_type(*numbers)
        arrays = [one if one.dtype == bool else one.astype(common) for one in arrays]
    shape = jnp.broadcast_shapes(*(one.shape for one in arrays))
    return getattr(lax, name)(*(jnp.broadcast_to(one, shape) for one in arrays))
