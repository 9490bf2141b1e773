"""Wrong usage, help and version."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import glid_nb

WHOLE_PIXELS = "--size: a side is a whole number of pixels, 1 to 20000, not '10.5'"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["deform"], "invalid choice: 'deform'"),
        (["solve"], "the following arguments are required: PROBLEM.json"),
        (["solve", "p.json", "--max-iterations", "few"], "invalid int value: 'few'"),
        (["solve", "p.json", "--s", "small"], "invalid float value: 'small'"),
        (["trace", "a.png"], "the following arguments are required: --out"),
        (["render", "a.png", "m.json", "--out", "b.png", "--view", "top"], "invalid choice: 'top'"),
        (["render", "a.png", "m.json", "--out", "b.png", "--size", "0", "9"], "--size"),
        (["render", "a.png", "m.json", "--out", "b.png", "--size", "10.5", "20"], WHOLE_PIXELS),
        (["animate", "a.glid", "--out", "b.gif", "--background", "reddish"], "is not a colour"),
        (["audit", "a.npy", "--spacing", "1", "0"], "a step is a number other than 0, not '0'"),
        (["demo", "--unheard-of"], "unrecognized arguments: --unheard-of"),
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_2(run, words: list[str], message: str) -> None:
    outcome = run(*words)
    assert outcome.code == 2
    assert outcome.out == ""
    assert outcome.err.startswith("glid-nb: error: ")
    assert outcome.err.count("\n") == 1
    assert message in outcome.err
    assert "--help" in outcome.err


@pytest.mark.parametrize(
    "command", ["demo", "trace", "solve", "render", "animate", "audit", "samples"]
)
def test_every_command_explains_itself(run, command: str) -> None:
    outcome = run(command, "--help")
    assert outcome.code == 0
    assert outcome.out.startswith(f"usage: glid-nb {command}")
    assert max(map(len, outcome.out.splitlines())) <= 110


@pytest.mark.slow
def test_the_version_is_printed_without_loading_jax() -> None:
    source = (
        "import sys\n"
        "from glid_nb.cli import main\n"
        "try:\n    main(['--version'])\nfinally:\n    print('jax' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.stdout.splitlines() == [f"glid-nb {glid_nb.__version__}", "False"]


def test_samples_are_listed(run) -> None:
    outcome = run("samples")
    assert outcome.code == 0
    lines = outcome.out.splitlines()
    assert [line.split()[0] for line in lines] == list(glid_nb.samples.names())
    assert all(Path(line.split()[1]).is_file() for line in lines)
