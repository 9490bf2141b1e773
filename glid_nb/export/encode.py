"""Encode frames as files: animated GIF and PNG, MP4 and WebM, a sprite sheet, pictures in a zip.

Frames are (h, w, 4) uint8 arrays of the same size with straight alpha. They are opaque for formats
without transparency.
"""

import errno
import importlib.util
import io
import json
import math
import os
import subprocess
import tempfile
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb._errors import InputError
from glid_nb._files import zipped
from glid_nb.imaging.backdrop import RGB, WHITE, Backdrop, check_background
from glid_nb.imaging.bleed import bled
from glid_nb.imaging.rasterise import tiles
from glid_nb.imaging.read import png, srgb_chunk
from glid_nb.motion.settings import checked


@dataclass(frozen=True)
class Frames:
    """Frames that are drawn on demand, on all cores."""

    size: tuple[int, int]  # width and height, pixels
    count: int
    draw: Callable[[int], NDArray[np.uint8]]  # draws the frame of a number, in any thread

    @property
    def pictures(self) -> Iterator[NDArray[np.uint8]]:
        """All frames in their order."""
        return self.drawn(range(self.count))

    def drawn(self, numbers: Sequence[int]) -> Iterator[NDArray[np.uint8]]:
        """The frames of some numbers, in this order. Some frames ahead are drawn meanwhile."""
        n_threads = min(os.cpu_count() or 1, _MOST_THREADS, len(numbers))
        if n_threads < 2 or len(tiles(self.size)) >= _MANY_TILES:  # a large frame uses all cores
            yield from map(self.draw, numbers)
            return
        pool = ThreadPoolExecutor(n_threads, thread_name_prefix="glid-nb-frames")
        ahead: deque[Future[NDArray[np.uint8]]] = deque()
        try:
            for number in numbers:
                ahead.append(pool.submit(self.draw, number))
                if len(ahead) > 2 * n_threads:
                    yield ahead.popleft().result()
            while ahead:
                yield ahead.popleft().result()
        finally:  # cancel frames that have not begun, also after Ctrl-C
            pool.shutdown(cancel_futures=True)


_MOST_THREADS = 4  # that draw frames; each needs some 50 MB
_MANY_TILES = 8  # with so many tiles, one frame is drawn by several threads
_PALETTE_FRAMES = 8  # a GIF's colours are chosen from so many frames at most
_LARGEST = 8192  # pixels of a frame's side
_LARGEST_SHEET = 16384  # pixels of a sprite sheet's side
_MOST_PIXELS = 2**30  # of all frames together, for formats that need all frames at once
# ffmpeg's settings, close to lossless for drawings. The colour space is named, because browsers
# would guess it otherwise.
_CODECS = {
    ".mp4": ("-c:v", "libx264", "-crf", "16", "-preset", "slow", "-movflags", "+faststart"),
    ".webm": ("-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-auto-alt-ref", "0"),
}
_COLORS = (
    "-vf",
    "scale=out_color_matrix=bt709:out_range=tv,"
    "setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709:range=tv",
)


def check_settings(size: Any, fps: Any, background: Any, suffix: str) -> Backdrop:
    """The background as `check_background` gives it. Raises an InputError that names a setting out
    of range or a missing package."""
    checked("size", int, size, least=16, most=_LARGEST)
    # GIF counts in hundredths of a second. Players slow down frames shorter than two hundredths.
    of, most = (" of a GIF", 50) if suffix == ".gif" else ("", 100)
    checked(f"frames_per_second{of}", float, fps, above=0, most=most)
    background = check_background(background)
    if background is None and suffix in (".gif", ".mp4"):
        remedy = "choose a background, or .apng or .webm"
        raise InputError(f"{suffix[1:].upper()} has no transparency; {remedy}")
    if suffix in _CODECS and importlib.util.find_spec("imageio_ffmpeg") is None:
        needed = "MP4 and WebM need the package imageio-ffmpeg, which includes ffmpeg"
        raise InputError(f"{needed}: pip install 'glid-nb[video]'")
    return background


def encoded(
    frames: Frames, name: str, suffix: str, fps: float, background: Backdrop, loop: bool = True
) -> list[bytes]:
    """The contents of the files of a suffix; for "", every frame as PNG."""
    if suffix in (".gif", ".apng"):
        return [_animation(frames, suffix, fps, background, loop)]
    if suffix in _CODECS:
        return [_video(frames, fps, suffix, background is None)]
    if suffix == ".sheet.png":
        return _sprite_sheet(frames, fps, name)
    pictures = [png(bled(picture)) for picture in frames.pictures]
    files = dict(zip(names(frames.count), pictures, strict=True))
    return [zipped(files, stored=files)] if suffix == ".zip" else pictures


def _animation(frames: Frames, suffix: str, fps: float, background: Backdrop, loop: bool) -> bytes:
    """An animated PNG, or a GIF. A GIF has 256 colours and counts in hundredths of a second."""
    width, height = frames.size
    if frames.count * width * height > _MOST_PIXELS:
        what = f"{frames.count} frames of {width} x {height} pixels are too many at once"
        raise InputError(f"{what}; choose a smaller size, fewer frames per second, or a video")
    settings: dict[str, Any] = {"duration": 1000 / fps, "loop": int(not loop)}
    if suffix == ".apng":
        pictures = [Image.fromarray(frame) for frame in frames.pictures]
    else:
        pictures = _with_palette(frames, background if isinstance(background, tuple) else WHITE)
        ends = np.round(np.arange(frames.count + 1) * 100 / fps)
        settings = {"duration": (10 * np.diff(ends)).astype(int).tolist()}
        settings |= {"loop": 0} if loop else {}
    settings |= {"save_all": True, "optimize": False, "append_images": pictures[1:]}
    settings |= {"pnginfo": srgb_chunk()} if suffix == ".apng" else {}
    buffer = io.BytesIO()
    pictures[0].save(buffer, "GIF" if suffix == ".gif" else "PNG", **settings)
    return buffer.getvalue()


def _video(frames: Frames, fps: float, suffix: str, transparent: bool) -> bytes:
    """A video with even sides. ffmpeg gets the frames while they are drawn."""
    from imageio_ffmpeg import get_ffmpeg_exe  # noqa: PLC0415 - an extra

    size = "x".join(map(str, frames.size))
    given = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", size, "-r", str(fps), "-i", "-"]
    pixels = ["-pix_fmt", "yuva420p" if transparent else "yuv420p"]
    with tempfile.TemporaryDirectory(prefix="glid_nb-") as folder:
        path, log = Path(folder) / f"frames{suffix}", Path(folder) / "log"
        program = get_ffmpeg_exe()
        command = [program, "-v", "error", *given, *_CODECS[suffix], *_COLORS, *pixels]
        with log.open("wb") as told, running([*command, str(path)], told) as ffmpeg:
            assert ffmpeg.stdin is not None
            try:
                for frame in frames.pictures:
                    ffmpeg.stdin.write(frame.tobytes())
            except BaseException as error:
                if not _is_broken_pipe(error):  # at a broken pipe ffmpeg has ended; see its log
                    ffmpeg.kill()
                    raise
        if ffmpeg.returncode or not path.is_file():
            said = log.read_text(encoding="utf-8", errors="replace")[-500:]
            told = f"exit code {ffmpeg.returncode}: {said or 'no message'}"
            raise OSError(f"ffmpeg ({program}) could not write the {suffix} video, {told}")
        return path.read_bytes()


def _is_broken_pipe(error: BaseException) -> bool:
    """Whether a pipe's other end has ended. Windows reports "invalid argument" for this."""
    return isinstance(error, OSError) and error.errno in (errno.EPIPE, errno.EINVAL)


def running(command: list[str], told: IO[bytes]) -> subprocess.Popen[bytes]:
    """The process of a command, which reads frames and writes its messages to ``told``."""
    try:
        return subprocess.Popen(command, stdin=subprocess.PIPE, stderr=told)
    except OSError as error:
        what = f"ffmpeg cannot be run, {command[0]}: {error.strerror}"
        remedy = "pip install 'glid-nb[video]' again, or correct IMAGEIO_FFMPEG_EXE"
        raise InputError(f"{what}; {remedy}") from error


def _sprite_sheet(frames: Frames, fps: float, name: str) -> list[bytes]:
    """One picture with all frames, and JSON with their places in TexturePacker's "hash" format and
    Pixi's ``animations``."""
    (width, height), columns = frames.size, math.ceil(math.sqrt(frames.count))
    sides = columns * width, math.ceil(frames.count / columns) * height
    if max(sides) > _LARGEST_SHEET:
        what = f"{frames.count} frames of {width} x {height} pixels"
        need = f"need a sheet of {sides[0]} x {sides[1]}; {_LARGEST_SHEET} is the most"
        raise InputError(f"{what} {need}, so choose a smaller size or fewer frames per second")
    sheet = np.zeros((*sides[::-1], 4), np.uint8)
    size, found = {"w": width, "h": height}, {}
    for i, (picture, frame) in enumerate(zip(frames.pictures, names(frames.count), strict=True)):
        x, y = i % columns * width, i // columns * height
        sheet[y : y + height, x : x + width] = bled(picture)
        found[frame] = {
            **{"frame": {"x": x, "y": y, **size}, "rotated": False, "trimmed": False},
            **{"spriteSourceSize": {"x": 0, "y": 0, **size}, "sourceSize": size},
            "duration": 1000 / fps,
        }
    meta = {
        **{"app": "glid_nb", "version": "1.0", "image": name, "format": "RGBA8888"},
        **{"size": dict(zip("wh", sides, strict=True)), "scale": "1"},
    }
    told = {"frames": found, "animations": {name.partition(".")[0]: list(found)}, "meta": meta}
    return [png(sheet), json.dumps(told, indent=1).encode()]


def names(count: int) -> list[str]:
    """Names of the frames' files: frame-000.png and so on."""
    return [f"frame-{i:0{max(3, len(str(count - 1)))}}.png" for i in range(count)]


def _with_palette(frames: Frames, background: RGB) -> list[Image.Image]:
    """All frames in one common palette, chosen from at most eight of them.

    With a palette for each picture, flat areas would flicker. The exact background is the first
    colour, because an averaged one would show a dither pattern. The frames for the palette are
    drawn first. Each of the others gets its palette while the next ones are drawn.
    """
    chosen = range(0, frames.count, math.ceil(frames.count / _PALETTE_FRAMES))
    first = dict(
        zip(
            chosen,
            (np.ascontiguousarray(frame[..., :3]) for frame in frames.drawn(chosen)),
            strict=True,
        )
    )
    montage = Image.fromarray(np.concatenate(list(first.values())))
    colors = [*background, *(montage.quantize(255).getpalette() or [])]
    palette = Image.new("P", (1, 1))
    palette.putpalette(colors)

    def converted(pixels: NDArray[np.uint8]) -> Image.Image:
        indices = np.array(Image.fromarray(pixels).quantize(palette=palette))
        # Pillow looks up colours in bins of four levels, so it can miss the background.
        indices[(pixels == background).all(axis=2)] = 0
        picture = Image.fromarray(indices)
        picture.putpalette(colors)
        return picture

    result = {number: converted(first.pop(number)) for number in chosen}
    others = [number for number in range(frames.count) if number not in result]
    for number, pixels in zip(others, frames.drawn(others), strict=True):
        result[number] = converted(np.ascontiguousarray(pixels[..., :3]))
    return [result[number] for number in range(frames.count)]
