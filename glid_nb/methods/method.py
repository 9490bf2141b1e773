"""What a method is, and what it is given."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import math
import numbers
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from glid_nb._errors import InputError
from glid_nb.energies import Energy
from glid_nb.geometry import Domain, Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.result import Callback, DeformationMap, MethodResult
from glid_nb.solvers import Pose

Family = Literal["harmonic", "mesh", "linear"]

_EXTRA = "compare"
_DISTRIBUTIONS = {"igl": "libigl"}
"""Names under which packages are installed, where they are imported under another."""


class MethodError(InputError):
    """A method is unknown, cannot minimise the energy, lacks its package or a setting is wrong."""


@dataclass(frozen=True, eq=False)
class Inputs:
    """What every method is given."""

    method: str
    domain: Domain
    pose: Pose
    energy: Energy
    p2p_weight: float
    max_iterations: int
    align: bool
    """Begin with the rigid motion that brings the handles closest to their targets."""
    start: DeformationMap | None
    given_mesh: Triangulation | None
    n_vertices: int
    callback: Callback | None

    @property
    def harmonic_start(self) -> HarmonicMap | None:
        """The start of a method in the harmonic subspace.

        Raises
        ------
        MethodError
            When it is a map of a mesh.
        """
        if self.start is None or isinstance(self.start, HarmonicMap):
            return self.start
        raise MethodError(
            f"the method {self.method!r} works in the harmonic subspace and cannot start from a "
            "map of a mesh; give a HarmonicMap, or none"
        )

    def need_handles(self) -> None:
        """Raise :class:`MethodError` if there are no handles."""
        if not len(self.pose):
            raise MethodError(f"the method {self.method!r} needs at least one handle")

    def mesh(self) -> tuple[Triangulation, Any]:
        """The triangulation, and the (h,) vertex indices of the handles.

        Raises
        ------
        MethodError
            When a handle is no vertex of the given triangulation.
        """
        mesh = self.given_mesh
        if mesh is None:
            mesh = triangulate(self.domain.cage, self.n_vertices, points=self.pose.handles)
        if not len(self.pose):
            return mesh, np.empty(0, dtype=np.int32)
        gap = np.linalg.norm(mesh.vertices[:, None] - self.pose.handles, axis=2)
        index = gap.argmin(axis=0)
        missing = np.flatnonzero(gap.min(axis=0) > 1e-9 * self.domain.cage.longer_side)
        if missing.size:
            i = int(missing[0])
            x, y = self.pose.handles[i]
            raise MethodError(
                f"handle {i} at ({x:.6g}, {y:.6g}) is no vertex of the triangulation; make it with "
                "triangulate(cage, points=handles), or leave it out"
            )
        return mesh, index.astype(np.int32)


@dataclass(frozen=True)
class Method:
    """One way to deform a domain, as the solver panel offers it."""

    name: str
    title: str
    family: Family
    summary: str
    """One sentence."""
    run: Callable[..., MethodResult]
    """Called with :class:`Inputs` and the method's own settings as keywords."""
    max_iterations: int = 200
    energies: tuple[str, ...] | None = None
    """Names of the energies that it can minimise; ``None`` for any."""
    package: str | None = None
    """The optional package that it needs."""
    weighted: bool = True
    """Whether ``lambda`` counts; it does not where the handles reach their targets exactly."""
    restrict: Callable[[Energy, Mapping[str, Any]], None] | None = None
    """Raises :class:`MethodError` for energies and settings of the right kind that do not go."""

    @property
    def available(self) -> bool:
        """Whether its package is installed."""
        return self.package is None or importlib.util.find_spec(self.package) is not None

    @property
    def settings(self) -> Mapping[str, Any]:
        """The method's own settings and their defaults."""
        parameters = list(inspect.signature(self.run).parameters.values())[1:]
        return {p.name: p.default for p in parameters}

    @property
    def kinds(self) -> Mapping[str, Any]:
        """What each setting may be, as an annotation."""
        hints = get_type_hints(self.run)
        return {name: hints[name] for name in self.settings}

    def check(self, energy: Energy, settings: Mapping[str, Any]) -> None:
        """Raise :class:`MethodError` if it cannot run like this, saying what to do."""
        self._import_package()
        self.check_settings(settings)
        if self.restrict is not None:
            self.restrict(energy, {**self.settings, **settings})
        if self.energies is not None and energy.name not in self.energies:
            raise MethodError(
                f"the method {self.name!r} cannot minimise the energy {energy.name!r}; "
                f"choose one of {', '.join(self.energies)}"
            )

    def _import_package(self) -> None:
        """Import the optional package, or say why not and what to do."""
        if self.package is None:
            return
        distribution = _DISTRIBUTIONS.get(self.package, self.package)
        needs = f"the method {self.name!r} needs the package {distribution}"
        if not self.available:
            raise MethodError(
                f"{needs}, which is not installed; install it with: pip install 'glid-nb[{_EXTRA}]'"
            )
        try:
            importlib.import_module(self.package)
        except ImportError as error:
            raise MethodError(
                f"{needs}, which is installed but cannot be imported ({error}); install it again "
                f"with: pip install --force-reinstall {distribution}, or all of its extra with: "
                f"pip install --force-reinstall 'glid-nb[{_EXTRA}]'"
            ) from error

    def check_settings(self, settings: Mapping[str, Any]) -> None:
        """Raise :class:`MethodError` for settings that it does not have, or of another kind."""
        kinds = self.kinds
        for name, value in settings.items():
            if name not in self.settings:
                known = ", ".join(self.settings) or "none"
                raise MethodError(
                    f"the method {self.name!r} has no setting {name!r}; it has: {known}"
                )
            expected = unmet(kinds[name], value)
            if expected:
                raise MethodError(
                    f"the setting {name!r} of the method {self.name!r} must be {expected}, "
                    f"got {value!r:.60}"
                )


def unmet(kind: Any, value: Any) -> str:
    """What a value of an annotated kind must be, if this one is not; empty if it is."""
    if get_origin(kind) is Literal:
        allowed = get_args(kind)
        known = isinstance(value, str) and value in allowed
        return "" if known else f"one of {', '.join(allowed)}"
    if get_args(kind):
        each = [unmet(one, value) for one in get_args(kind)]
        return "" if "" in each else " or ".join(each)
    if kind is type(None):
        return "" if value is None else "None"
    if kind is bool:
        return "" if isinstance(value, bool | np.bool_) else "True or False"
    whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if kind is int:
        return "" if whole and int(value) >= 0 else "a whole number of at least 0"
    real = whole or (isinstance(value, numbers.Real) and not isinstance(value, bool))
    fits = real and math.isfinite(value) and float(value) >= 0
    return "" if fits else "a finite number of at least 0"
