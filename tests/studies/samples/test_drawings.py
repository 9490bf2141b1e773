"""The code in the repository draws the pictures in the repository."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from glid_nb import samples
from studies.samples import draw


@pytest.mark.slow
@pytest.mark.parametrize("name", samples.names())
def test_drawn_anew_the_picture_is_the_same(name: str) -> None:
    drawn, kept = draw.draw(name).astype(int), samples.image(name).astype(int)
    assert drawn.shape == kept.shape
    difference = np.abs(drawn - kept)
    assert difference.mean() < 0.02
    assert np.mean(difference > 24) < 1e-3, "other versions of the rasteriser move edges only"


@pytest.mark.slow
def test_the_command_writes_the_same_file_twice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = []
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        draw.main(["bar", "--out", str(tmp_path / folder)])
        files.append((tmp_path / folder / "bar.png").read_bytes())
    assert files[0] == files[1]
    assert capsys.readouterr().out.splitlines()[0] == str(tmp_path / "one" / "bar.png")
    assert samples.path("bar").parent not in tmp_path.parents


def test_an_unknown_name_ends_with_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        draw.main(["gekko"])
    assert stop.value.code == 2
    assert "there is no sample 'gekko'" in capsys.readouterr().err
