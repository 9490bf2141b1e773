"""A solving method: a value whose fields are its settings."""

import importlib
import importlib.util
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, ClassVar, Literal

from glid_nb._arguments import check_fields, field_kinds
from glid_nb._errors import InputError
from glid_nb.certificate import Certificate, certificate_of
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import DeformationMap, Pose, in_both
from glid_nb.solvers.options import Options
from glid_nb.solvers.result import Callback, Result

Family = Literal["harmonic", "mesh", "linear"]

_EXTRA = "compare"
_DISTRIBUTIONS = {"igl": "libigl"}
"""The distribution's name of each imported package whose two names differ."""


class MethodError(InputError):
    """A method is unknown, cannot minimise the energy, lacks its package or a setting is wrong."""


class StartError(InputError):
    """The map to start from cannot be used."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Inputs:
    """The problem that a method solves."""

    domain: Domain
    pose: Pose
    energy: Energy
    options: Options
    start: DeformationMap | Result | None = None
    callback: Callback | None = None

    @property
    def start_map(self) -> DeformationMap | None:
        return self.start.map if isinstance(self.start, Result) else self.start


@dataclass(frozen=True)
class Method:
    """A way to deform a domain, for the argument ``method`` of :func:`glid_nb.solve`.

    Subclasses are frozen dataclasses; their fields are the method's own settings. A MethodError
    names a setting that has the wrong type or is out of range.
    """

    name: ClassVar[str]  # for files and the shell
    label: ClassVar[str]  # for menus
    summary: ClassVar[str]  # the first paragraph of the class's docstring
    family: ClassVar[Family]
    """The kind of its maps: "harmonic" maps lie in the harmonic subspace and are certified, "mesh"
    maps are piecewise linear. "linear" methods also use a mesh and solve once."""
    max_iterations: ClassVar[int] = 200  # the default; the options can change it
    window: ClassVar[int | None] = None
    """The method has converged when this many iterations together change the energy by no more
    than the fraction ``tolerance``. None for a method with another stopping rule."""
    tolerance: ClassVar[float] = 0.0
    energies: ClassVar[tuple[str, ...] | None] = None  # that it can minimise; None for any
    stiffens: ClassVar[bool] = True  # whether a method with certified maps keeps stiff areas
    package: ClassVar[str | None] = None  # the optional package that it needs
    options: ClassVar[tuple[str, ...]] = ("p2p_weight", "align", "max_iterations")
    """Names of the :class:`~glid_nb.Options` that the method uses."""

    def __init_subclass__(cls) -> None:
        cls.summary = " ".join((cls.__doc__ or "").split("\n\n")[0].split())

    def __post_init__(self) -> None:
        method = f"of the method {self.name!r}"
        check_fields(self, MethodError, lambda name: f"the setting {name!r} {method}")

    def run(self, inputs: Inputs) -> Result:
        """Deform. :func:`glid_nb.solve` has checked the inputs."""
        raise NotImplementedError

    @classmethod
    def kinds(cls) -> Mapping[str, Any]:
        """The type of each setting, as an annotation."""
        return field_kinds(cls)

    @classmethod
    def defaults(cls) -> Mapping[str, Any]:
        return {f.name: f.default for f in fields(cls) if f.default is not MISSING}

    @property
    def settings(self) -> dict[str, Any]:
        """The settings that differ from the defaults."""
        return {k: getattr(self, k) for k, v in self.defaults().items() if getattr(self, k) != v}

    @property
    def certified(self) -> bool:
        """Whether its maps are proved locally injective."""
        return self.family == "harmonic"

    @classmethod
    def available(cls) -> bool:
        """Whether the package that it needs is installed."""
        return cls.package is None or importlib.util.find_spec(cls.package) is not None

    def check(self, energy: Energy, pose: Pose) -> None:
        """Raise a :class:`MethodError`, with a remedy, if it cannot solve this problem."""
        if self.package is not None:
            self._import(self.package)
        method = f"the method {self.name!r}"
        if self.energies is not None and energy.name not in self.energies:
            cannot = f"{method} cannot minimise the energy {energy.name!r}"
            raise MethodError(f"{cannot}; choose one of {', '.join(self.energies)}")
        other = "choose Newton's method, L-BFGS or another that moves the certified map"
        if pose.stiffness and not (self.stiffens and self.certified):
            raise MethodError(f"{method} does not support stiff areas; clear them, or {other}")
        if pose.oriented.any() and not self.certified:
            first = int(pose.oriented.argmax())
            cannot = f"{method} cannot hold the angle or the scale of"
            what = in_both(lambda named: f"{cannot} {named(first)}; leave them free, or {other}")
            raise MethodError(*what)

    def _import(self, package: str) -> None:
        distribution = _DISTRIBUTIONS.get(package, package)
        needs = f"the method {self.name!r} needs the package {distribution}"
        if not self.available():
            install = f"install it with: pip install 'glid-nb[{_EXTRA}]'"
            raise MethodError(f"{needs}, which is not installed; {install}")
        try:
            importlib.import_module(package)
        except ImportError as error:
            again = f"pip install --force-reinstall {distribution} (or 'glid-nb[{_EXTRA}]')"
            broken = f"{needs}, which is installed but cannot be imported ({error})"
            raise MethodError(f"{broken}; install it again with: {again}") from error

    def proved_start(self, inputs: Inputs) -> Certificate | None:
        """The certificate of the given start map, its own or a new one; None if no start is given.

        Raises a :class:`MethodError` for a map of a mesh, a :class:`StartError` for a map that
        cannot be proved.
        """
        start, map = inputs.start, inputs.start_map
        if map is None:
            return None
        if not isinstance(map, HarmonicMap):
            cannot = f"the method {self.name!r} cannot start from a map of a mesh"
            raise MethodError(f"{cannot}; give a HarmonicMap, or none")
        known = start.step_certificate if isinstance(start, Result) else None
        if known is None or not (known.certified and known.belongs_to(map)):
            known = certificate_of(map)
        if not known.certified:
            raise StartError(f"the map to start from is not certified: {known.reason}")
        return known
