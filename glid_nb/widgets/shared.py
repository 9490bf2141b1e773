"""Controls of numbers that several things may have: the number that all have, else "mixed"."""

from collections.abc import Sequence

import ipywidgets
import numpy as np

from glid_nb._arrays import Array

_MIXED = "mixed"


def show_texts(field: ipywidgets.Text, texts: Sequence[str], empty: str = "") -> None:
    """Show in a field the text that all have, else an empty field that says "mixed".

    ``empty`` is what the field says if all texts are empty.
    """
    mixed = len(set(texts)) > 1
    with field.hold_sync():
        field.placeholder = _MIXED if mixed else empty
        field.value = "" if mixed else texts[0]


def show_powers(slider: ipywidgets.FloatLogSlider, numbers: Array, tooltip: str) -> None:
    """Show on a slider the number that all have. If they differ, it stands pale at their mean."""
    mixed = bool(np.ptp(numbers))
    (slider.add_class if mixed else slider.remove_class)("glid-mixed")
    with slider.hold_sync():
        slider.tooltip = f"{tooltip} ({_MIXED})" if mixed else tooltip
        slider.value = float(np.exp(np.log(numbers).mean())) if mixed else float(numbers[0])
