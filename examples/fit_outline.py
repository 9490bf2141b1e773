"""Fit the targets of three pins to an outline by gradient descent."""

import jax
import jax.numpy as jnp

import glid_nb as glid

jax.config.update("jax_enable_x64", True)

domain = glid.Domain.from_cage(glid.Cage([[-4, -1], [0, -1], [4, -1], [4, 1], [0, 1], [-4, 1]]))
pose = glid.Pose([[-3.5, 0], [0, 0], [3.5, 0]], [[-3.5, 0], [0, 0], [3.5, 0]])
side = jnp.linspace(-3.5, 3.5, 15)
points = jnp.stack([side, jnp.full(15, 0.8)], axis=1)  # along the upper side
outline = points + jnp.stack([0 * side, 0.08 * side**2], axis=1)  # a parabola
f = glid.differentiable(domain, pose, start=glid.solve(domain, pose))


def loss(targets):
    return jnp.mean(jnp.sum((f(targets)(points) - outline) ** 2, axis=1))


targets = jnp.asarray(pose.targets)
for step in range(12):
    value, slope = jax.value_and_grad(loss)(targets)
    print(f"{step:2d}  loss {value:.5f}")
    targets -= 0.8 * slope
print("certified:", glid.certify(f(targets).map).certified)
