"""Which method solves a pose, as a value that an editor and a file hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from glid_nb.energies import Energy
from glid_nb.methods.method import Method, MethodError
from glid_nb.methods.registry import methods
from glid_nb.solvers import Options

OURS = "newton"
"""The method that is meant where none is named."""

# A method takes these from the options, so that they stay when another method is chosen.
_FROM_OPTIONS = ("sampling", "certificate", "conformal")


@dataclass(frozen=True)
class MethodChoice:
    """One of :func:`glid_nb.methods.methods` with settings of its own.

    Parameters
    ----------
    name : str
    settings : mapping
        Those of :attr:`own_settings` that differ from the method's defaults.

    Raises
    ------
    MethodError
        For an unknown method, an unknown setting, or one out of its range.
    """

    name: str = OURS
    settings: Mapping[str, Any] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        known = methods()
        if not isinstance(self.name, str) or self.name not in known:
            raise MethodError(f"unknown method {self.name!r}; choose one of {', '.join(known)}")
        if not isinstance(self.settings, Mapping):
            raise MethodError(
                f"settings must be a mapping of names to values, got {self.settings!r:.60}"
            )
        for name in self.settings:
            if name not in self.own_settings:
                own = ", ".join(self.own_settings) or "none"
                raise MethodError(
                    f"the method {self.name!r} has no setting {name!r} of its own; it has: {own}"
                )
        object.__setattr__(self, "settings", MappingProxyType(dict(self.settings)))
        self.method.check_settings(self.settings)

    @property
    def method(self) -> Method:
        """The method itself."""
        return methods()[self.name]

    @property
    def own_settings(self) -> dict[str, Any]:
        """Settings that no option stands for, and their defaults."""
        if self.name == OURS:
            return {}
        return {k: v for k, v in self.method.settings.items() if k not in _FROM_OPTIONS}

    def takes(self, option: str) -> bool:
        """Whether an option of :class:`~glid_nb.solvers.Options` counts for this method."""
        if self.name == OURS or (option == "p2p_weight" and self.method.weighted):
            return True
        return option in _FROM_OPTIONS and option in self.method.settings

    def check(self, energy: Energy) -> None:
        """Raise :class:`MethodError` if it cannot minimise this energy or lacks its package."""
        self.method.check(energy, self.settings)

    def arguments(self, options: Options) -> dict[str, Any]:
        """What :func:`glid_nb.methods.run_method` is called with for these options."""
        names = ("p2p_weight", *_FROM_OPTIONS)
        return {
            **{name: getattr(options, name) for name in names if self.takes(name)},
            **self.settings,
        }
