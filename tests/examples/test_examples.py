"""The scripts in examples/ run unchanged, and print what they say."""

from __future__ import annotations

import functools
import runpy
from collections.abc import Iterator
from pathlib import Path

import jax
import pytest

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[2] / "examples"
WRITTEN = {
    "batch.py": [],
    "fit_outline.py": [],
    "most_important_handle.py": ["sensitivity.png"],
    "checked_elsewhere.py": ["map.json", "proof.json"],
    "motion_to_video.py": ["wave.mp4"],
    "own_energy.py": ["energies.png"],
    "picture_to_map.py": ["deformed.png", "map.json"],
}
MOST_LINES = 30


def test_every_script_is_tried_and_short() -> None:
    scripts = {path.name: path.read_text().count("\n") for path in EXAMPLES.glob("*.py")}
    assert scripts.keys() == WRITTEN.keys()
    assert max(scripts.values()) <= MOST_LINES


@pytest.fixture
def _precision_as_it_was() -> Iterator[None]:
    """A script may set JAX to double precision for its process, which is ours here."""
    before = jax.config.values["jax_enable_x64"]
    yield
    jax.config.update("jax_enable_x64", before)


@pytest.mark.usefixtures("_precision_as_it_was")
@pytest.mark.parametrize("name", WRITTEN)
def test_a_script_runs(
    name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [name])
    run = functools.partial(runpy.run_path, str(EXAMPLES / name), run_name="__main__")
    if name == "checked_elsewhere.py":
        with pytest.raises(SystemExit) as ended:
            run()
        assert ended.value.code == 0
    else:
        run()
    assert sorted(path.name for path in tmp_path.iterdir()) == WRITTEN[name]
    out = capfd.readouterr().out
    if name == "checked_elsewhere.py":
        assert out.startswith("VERIFIED")
    if name == "batch.py":
        assert out.count("converged") == 16
