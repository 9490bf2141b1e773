"""The live page as a widget: the page solves and proves, and the kernel gets its maps."""

from typing import Any

import numpy as np
import traitlets

from glid_nb import export
from glid_nb._errors import InputError
from glid_nb.certificate import Certificate, certify
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.read import ImageSource, read_image
from glid_nb.imaging.trace import trace
from glid_nb.page import bundle, coefficients_of, pins_of
from glid_nb.pose import Pose
from glid_nb.widgets.closing import ClosingWidget, one_a_cell
from glid_nb.widgets.pad import answer_during_cells
from glid_nb.widgets.page_widget import PageWidget

_KERNEL = "kernel"  # who has changed the pose, if no view has; live_editor/main.js knows it too


class LiveEditor(ClosingWidget, PageWidget):
    """A picture whose pins are dragged, solved and proved by the page itself.

    A drag never waits for the kernel or the network, and it goes on while a cell runs. It is one
    widget without pythreejs, so it also works where :class:`Editor` does not, as in marimo. When
    the page comes to rest, the kernel gets its pose and map, and certifies the map anew.

    ``shown`` is a domain, or a map to begin with; by default the picture is traced. ``pose`` has
    the map's pins; their depths and its stiff areas stay as they are. ``height`` is in CSS pixels;
    the widget is as wide as there is room.

    Raises an InputError for an energy that the page's solver does not have.

    >>> import glid_nb as glid
    >>> live = glid.widgets.LiveEditor(glid.samples.image("bar"))
    >>> live.pose = glid.Pose([[-6, 0], [6, 0]], [[-6, 0], [5.5, 2]])
    >>> len(live.pose), live.certificate.certified
    (2, True)
    >>> live.close()
    """

    _script = traitlets.Unicode(bundle("live_editor")).tag(sync=True)

    page = traitlets.Unicode("", read_only=True).tag(sync=True)
    """The page's HTML."""
    title = traitlets.Unicode("", read_only=True).tag(sync=True)
    height = traitlets.Int(520, read_only=True).tag(sync=True)
    edit = traitlets.Dict({}).tag(sync=True)
    """What was changed last: ``by`` whom, ``pins``, and the map's ``coefficients``. To hear of a
    new map, ``observe`` this."""

    @one_a_cell
    def __init__(
        self,
        image: ImageSource,
        shown: Domain | HarmonicMap | None = None,
        pose: Pose | None = None,
        energy: Energy | None = None,
        *,
        p2p_weight: float = 1e5,
        title: str = "Live picture",
        height: int = 520,
        **kwargs: Any,
    ) -> None:
        picture = read_image(image)
        if shown is None:
            shown = Domain.from_cage(trace(picture).cage)
        html = export.live_page_html(picture, shown, pose, energy, p2p_weight, title)
        domain = export.page_domain(shown if isinstance(shown, Domain) else shown.domain)
        start = shown if isinstance(shown, HarmonicMap) else HarmonicMap.identity(domain)
        self._pose = pose if pose is not None else Pose([], [])
        self._take(HarmonicMap(domain, start.phi, start.psi))
        super().__init__(**kwargs)
        for name, value in {"page": html, "title": title, "height": height}.items():
            self.set_trait(name, value)
        answer_during_cells(self)

    @property
    def map(self) -> HarmonicMap:
        """The map at which the page came to rest last, certified by :func:`~glid_nb.certify`."""
        return self._map

    @property
    def certificate(self) -> Certificate:
        """The certificate of :attr:`map`."""
        return self._certificate

    @property
    def pose(self) -> Pose:
        """The pins. A pose that is set goes to the page, which solves it from :attr:`map` on.

        Setting raises a PoseError for pins outside the domain.
        """
        return self._pose

    @pose.setter
    def pose(self, pose: Pose) -> None:
        pose.check_inside(self.map.domain)
        coefficients = coefficients_of(self.map)
        self.edit = {"by": _KERNEL, "pins": pins_of(pose), "coefficients": coefficients}

    @traitlets.validate("edit")
    def _check_edit(self, proposal: dict[str, Any]) -> dict[str, Any]:
        """Take the pose and the map of an edit, if the map is certified."""
        edit, domain = proposal["value"], self.map.domain
        if edit.get("by") is not None:
            try:
                pose = self._pose_of(edit["pins"])
                pose.check_inside(domain)
                self._take(_map_of(domain, edit["coefficients"]))
            except InputError as error:  # after this one, traitlets goes back to the value before
                raise traitlets.TraitError(str(error)) from error
            self._pose = pose
        return edit

    def _take(self, map: HarmonicMap) -> None:
        certificate = certify(map)
        if not certificate.certified:
            raise InputError(f"the page's map was refused: {certificate.reason}")
        self._map, self._certificate = map, certificate

    def _pose_of(self, pins: list[dict[str, Any]]) -> Pose:
        def column(key: str) -> list[Any]:
            return [np.nan if pin[key] is None else pin[key] for pin in pins]

        return Pose(
            column("handle"),
            column("target"),
            column("depth"),
            angles=column("angle"),
            scales=column("scale"),
            weights=column("weight"),
            names=column("name"),
            stiffness=self._pose.stiffness,
        )


def _map_of(domain: Domain, coefficients: list[float]) -> HarmonicMap:
    """The map whose coefficients are the real and imaginary parts of phi, then of psi."""
    phi, psi = np.reshape(coefficients, (2, 2, -1)).transpose(0, 2, 1) @ [1, 1j]
    return HarmonicMap(domain, phi, psi)
