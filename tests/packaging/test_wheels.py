"""The wheels, each installed alone in its own environment, far from the checkout."""

from __future__ import annotations

import json
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

from .environments import CHECKOUT, Built, Environment, build, run

# In one group, so that one process builds and installs.
pytestmark = [pytest.mark.install, pytest.mark.timeout(600), pytest.mark.xdist_group("wheels")]

SCRIPT = Path(__file__).with_name("installed.py")


@pytest.fixture(scope="module")
def main(tmp_path_factory: pytest.TempPathFactory) -> Built:
    return build(CHECKOUT, tmp_path_factory.mktemp("main"))


@pytest.fixture(scope="module")
def checker(tmp_path_factory: pytest.TempPathFactory) -> Built:
    return build(CHECKOUT / "checker", tmp_path_factory.mktemp("checker"))


@pytest.fixture(scope="module")
def user(main: Built, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """An environment with the wheel of glid-nb and no extra."""
    made = Environment(tmp_path_factory.mktemp("user") / "environment")
    made.install(main.wheel)
    return made


@pytest.fixture(scope="module")
def verifier(checker: Built, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """An environment with the wheel of glid-check alone."""
    made = Environment(tmp_path_factory.mktemp("verifier") / "environment")
    made.install(checker.wheel)
    return made


@pytest.fixture(scope="module")
def work(user: Environment, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the commands were run one after the other, with only the wheel
    installed."""
    folder = tmp_path_factory.mktemp("work")

    def glid_nb(*words: object) -> str:
        python = user.program("python")
        return run(python, SCRIPT, CHECKOUT, *words, folder=folder, MPLBACKEND="agg")

    glid_nb("demo", "--out", "demo")
    pictures = json.loads(glid_nb("samples", "--json"))["gecko"]
    glid_nb("trace", pictures["picture"], "--out", "cage.json")
    cage = json.loads((folder / "cage.json").read_text(encoding="utf-8"))
    pose = json.loads(Path(pictures["poses"]["gentle"]).read_text(encoding="utf-8"))
    kept = {key: cage[key] for key in ("cage", "holes", "image_size_px")}
    text = json.dumps({**kept, **{key: pose[key] for key in ("handles", "targets")}})
    (folder / "problem.json").write_text(text, encoding="utf-8")
    glid_nb("solve", "problem.json", "--out", "map.json", "--proof", "proof.json")
    glid_nb("render", pictures["picture"], "map.json", "--out", "deformed.png", "--size", 64, 64)
    glid_nb("editor")
    glid_nb("motion")
    small = ("--size", 48, "--fps", 4, "--seconds", 1)
    glid_nb(
        "animate", "walk.motion.json", "--picture", pictures["picture"], "--out", "a.gif", *small
    )
    return folder


@pytest.mark.parametrize("name", ["main", "checker"])
def test_an_sdist_builds_the_wheel_of_its_checkout(
    name: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    from_sdist: Built = request.getfixturevalue(name)
    source = CHECKOUT if name == "main" else CHECKOUT / "checker"
    run(sys.executable, "-m", "build", "--wheel", "--outdir", tmp_path, source, folder=tmp_path)
    (direct,) = tmp_path.glob("*.whl")
    assert direct.name == from_sdist.wheel.name
    assert members(direct) == members(from_sdist.wheel)


def members(wheel: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_the_checkers_code_is_in_its_own_wheel_alone(main: Built, checker: Built) -> None:
    assert "glid_check.py" not in members(main.wheel)
    modules = {name for name in members(checker.wheel) if name.endswith(".py")}
    assert modules == {"glid_check.py"}
    with tarfile.open(main.sdist) as archive:
        names = archive.getnames()
    assert any(name.endswith("/checker/pyproject.toml") for name in names)


def test_the_wheel_holds_the_pages_bundles_and_the_sdist_what_they_are_made_of(main: Built) -> None:
    page = CHECKOUT / "glid_nb" / "page"
    folders = ("built", "glsl", "html")
    files = [path for folder in folders for path in (page / folder).iterdir()]
    held = members(main.wheel)
    for path in files:
        assert held[path.relative_to(CHECKOUT).as_posix()] == path.read_bytes()
    assert not any(name.startswith("glid_nb/page/js/") for name in held)
    with tarfile.open(main.sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert names >= {"glid_nb/page/js/canvas/main.js", "package-lock.json", "tools/build_page.js"}


def test_both_carry_one_version(main: Built, checker: Built) -> None:
    versions = {built.wheel.name.split("-")[1] for built in (main, checker)}
    assert len(versions) == 1
    extra = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))
    (wanted,) = extra["project"]["optional-dependencies"]["check"]
    assert wanted.startswith("glid-check>=")


def test_the_wheel_alone_traces_solves_and_draws_without_a_warning(work: Path) -> None:
    assert (work / "demo" / "overview.png").stat().st_size > 10_000
    report = json.loads((work / "demo" / "report.json").read_text(encoding="utf-8"))
    assert report["certified"] is True
    for name in ("deformed.png", "a.gif", "session.glid", "map.json", "proof.json"):
        assert (work / name).stat().st_size > 500


def test_the_wheel_needs_no_extra_and_brings_no_checker(user: Environment, work: Path) -> None:
    assert work.is_dir()
    assert not {"glid-check", "python-flint", "libigl", "clarabel"} & user.packages()


def test_the_checkers_wheel_needs_python_flint_alone(verifier: Environment) -> None:
    assert verifier.packages() == {"glid-check", "python-flint"}


def test_the_installed_checker_verifies_what_the_installed_package_proved(
    verifier: Environment, work: Path
) -> None:
    said = run(verifier.program("glid-check"), "map.json", "proof.json", folder=work)
    assert said.startswith("VERIFIED: the map is locally injective")


def test_the_installed_command_knows_its_version(user: Environment, tmp_path: Path) -> None:
    said = run(user.program("glid-nb"), "--version", folder=tmp_path)
    name = next(path.name for path in user.folder.rglob("glid_nb-*.dist-info"))
    assert said.split() == ["glid-nb", name.removeprefix("glid_nb-").removesuffix(".dist-info")]
