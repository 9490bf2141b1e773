"""Read the layers of a Photoshop file, with the optional package psd-tools."""

import importlib
import os
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._files import read_file
from glid_nb.imaging.decode import check_size
from glid_nb.imaging.frame import TraceError

SUFFIXES = (".psd", ".psb")
_NEEDED = "the layers of a Photoshop file need the package psd-tools: pip install 'glid-nb[psd]'"
_COMPOSITED = ("RGB", "GRAYSCALE")  # the colour modes whose composites have alpha
_FILLED = ("shape", "solidcolorfill", "gradientfill", "patternfill")  # drawn without pixels
_EFFECTS = ("ColorOverlay", "GradientOverlay", "PatternOverlay", "Stroke")  # that are drawn
_PLAIN_BLENDS = ("NORMAL", "PASS_THROUGH")

_Path = tuple[Any, ...]
"""A layer, after the groups around it, the outermost first."""


class LayerWarning(UserWarning):
    """Something of a Photoshop file's layer is not drawn."""


def photoshop_layers(path: str | os.PathLike[str]) -> list[tuple[str, NDArray[np.uint8]]]:
    """The visible layers of a file with their names, the rearmost first.

    Each picture is (h, w, 4) RGBA of the document's size, transparent beside the layer. Layers of
    groups count like others. Each is drawn alone, with the layers that are clipped to it, its masks
    and opacity and those of the groups around it, and the effects that psd-tools can draw. A
    LayerWarning names what is left out. Raises a TraceError if psd-tools is missing or the file
    cannot be read.
    """
    try:
        psd_tools: Any = importlib.import_module("psd_tools")  # an extra
    except ImportError:
        raise TraceError(_NEEDED) from None
    read_file(path)  # its errors name the file
    try:
        document = psd_tools.PSDImage.open(Path(path))
        check_size(*document.size)
        _release(document)
        drawn = [(str(way[-1].name), *_drawn(document, way)) for way in _ways(document)]
        left_out = [text for *_, undrawn in drawn for text in undrawn] + _adjusting(document)
    except TraceError:
        raise
    except Exception as error:  # decoders raise errors of any type
        raise TraceError(f"{path} is damaged or no Photoshop file: {error}") from None
    if left_out:
        left_out = list(dict.fromkeys(left_out))  # a group's belongs to each of its layers
        text = f"{Path(path).name} is drawn without {'; '.join(left_out)}"
        warnings.warn(text, LayerWarning, stacklevel=2)
    return [(name, pixels) for name, pixels, _ in drawn]


def _release(group: Any) -> None:
    """Unclip the layers that no layer below them holds, in a document that is only read.

    Otherwise they would not be drawn: those at the bottom of the document or of a group, and those
    above a clipped group.
    """
    layers = list(group)
    held = {id(one) for base in layers for one in base.clip_layers}
    for layer in [one for one in layers if one.clipping and id(one) not in held]:
        layer.clipping = False
    for layer in layers:
        if layer.is_group():
            _release(layer)


def _ways(group: Any, around: _Path = ()) -> Iterator[_Path]:
    """The visible layers that can be drawn in a group, the rearmost first, but no clipped ones."""
    for layer in group:
        if not layer.visible or layer.clipping:
            continue
        if layer.is_group():
            yield from _ways(layer, (*around, layer))
        elif layer.has_pixels() or layer.kind in _FILLED:
            yield (*around, layer)


def _drawn(document: Any, way: _Path) -> tuple[NDArray[np.uint8], list[str]]:
    """A layer on a transparent picture of the document's size, and what of it is not drawn."""
    size, layer = document.size, way[-1]
    undrawn = [text for one in way for text in [*_undrawn_effects(one), *_blending(one)]]
    clipped = [one for base in way for one in _clipped(base)]
    undrawn += [text for one in clipped for text in _undrawn_effects(one)]
    undrawn += [_adjustment(one) for one in clipped if _is_undrawn_adjustment(one)]
    if all(_is_plain(group) for group in way[:-1]) and _is_plain(layer, own_mask=True):
        return _alone(layer, size), undrawn
    if document.color_mode.name not in _COMPOSITED:
        what = f"clipped layers, effects, opacity and masks of groups of the layer {layer.name!r}"
        return _alone(layer, size), [*undrawn, f"{what}, in {document.color_mode.name.title()}"]
    shown = {id(one) for one in (*way, *clipped)}
    frame = (0, 0, *size)
    look = {"alpha": 0.0, "layer_filter": lambda one: id(one) in shown, "ignore_preview": True}
    try:
        picture = document.composite(viewport=frame, **look)
        if "A" not in picture.getbands():  # early versions drop alpha unless they draw all anew
            picture = document.composite(viewport=frame, force=True, **look)
    except ImportError as error:  # of a package that draws paths
        return _alone(layer, size), [*undrawn, f"paths of the layer {layer.name!r} ({error})"]
    pixels = np.array(picture.convert("RGBA"))
    pixels[pixels[..., 3] == 0] = 0  # some are white, some black
    return pixels, undrawn


def _clipped(base: Any) -> list[Any]:
    """The visible layers that are clipped to one, with all in them."""
    clipped = [one for one in base.clip_layers if one.visible]
    return clipped + [
        inner
        for one in clipped
        if one.is_group()
        for inner in one.descendants()
        if inner.is_visible()
    ]


def _is_plain(layer: Any, own_mask: bool = False) -> bool:
    """Whether a layer's pixels, with its mask if ``own_mask``, are all that is seen of it."""
    masked = layer.has_vector_mask() or (layer.has_mask() and not own_mask)
    faint = min(layer.opacity, layer.fill_opacity) < 255
    pixels = layer.is_group() or layer.has_pixels()
    return pixels and not (masked or faint or _clipped(layer) or _effects(layer))


def _effects(layer: Any) -> list[str]:
    """The names of a layer's effects."""
    if not layer.effects.enabled:
        return []
    return [effect.name for effect in layer.effects if effect.enabled]


def _undrawn_effects(layer: Any) -> list[str]:
    names = [name for name in _effects(layer) if name not in _EFFECTS]
    words = [re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower() for name in names]
    return [f"the {word} of {_named(layer)}" for word in words]


def _blending(layer: Any) -> list[str]:
    """A blend mode, which needs what lies behind the part."""
    mode = layer.blend_mode.name
    return [] if mode in _PLAIN_BLENDS else [f"the blend mode {_words(mode)} of {_named(layer)}"]


def _adjusting(group: Any) -> list[str]:
    """The visible adjustment layers in a group, which change what lies behind them."""
    texts = []
    for layer in group:
        if layer.visible and layer.is_group():
            texts += _adjusting(layer)
        elif layer.visible and not layer.clipping and _is_adjustment(layer):
            texts.append(_adjustment(layer))
    return texts


def _adjustment(layer: Any) -> str:
    return f"the adjustment {layer.name!r}"


def _is_adjustment(layer: Any) -> bool:
    kinds: Any = importlib.import_module("psd_tools.api.layers")
    return isinstance(layer, kinds.AdjustmentLayer)


def _is_undrawn_adjustment(layer: Any) -> bool:
    """Whether psd-tools cannot draw a clipped adjustment; versions before 1.26 draw none."""
    if not _is_adjustment(layer):
        return False
    try:
        drawing: Any = importlib.import_module("psd_tools.composite.adjustments")
    except ImportError:
        return True
    return layer.kind not in getattr(drawing, "ADJUSTMENT_FUNC", ())


def _named(layer: Any) -> str:
    return f"the {'group' if layer.is_group() else 'layer'} {layer.name!r}"


def _words(name: str) -> str:
    return name.lower().replace("_", " ")


def _alone(layer: Any, size: tuple[int, int]) -> NDArray[np.uint8]:
    """A layer's pixels with its mask on a transparent picture of the document's size."""
    picture = layer.topil()
    if picture is None:
        return np.zeros((size[1], size[0], 4), np.uint8)
    drawn = _placed(np.asarray(picture.convert("RGBA")), layer.offset, size)
    mask = layer.mask
    if mask is not None and not mask.disabled:
        around = np.full((size[1], size[0], 1), mask.background_color, np.uint8)
        if (shown := mask.topil()) is not None:
            around = _placed(np.asarray(shown.convert("L"))[..., None], mask.bbox[:2], size, around)
        alpha = drawn[..., 3].astype(np.uint16) * around[..., 0]
        drawn[..., 3] = (alpha + 127) // 255
    return drawn


def _placed(
    pixels: NDArray[np.uint8],
    offset: tuple[int, int],
    size: tuple[int, int],
    around: NDArray[np.uint8] | None = None,
) -> NDArray[np.uint8]:
    """Pixels (h, w, c) at a place of a picture of the document's size, by default of zeros."""
    (left, top), (width, height) = offset, size
    placed = np.zeros((height, width, pixels.shape[2]), np.uint8) if around is None else around
    rows = slice(max(top, 0), min(top + pixels.shape[0], height))
    columns = slice(max(left, 0), min(left + pixels.shape[1], width))
    if rows.start < rows.stop and columns.start < columns.stop:
        own_rows = slice(rows.start - top, rows.stop - top)
        own_columns = slice(columns.start - left, columns.stop - left)
        placed[rows, columns] = pixels[own_rows, own_columns]
    return placed
