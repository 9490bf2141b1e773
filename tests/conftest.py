"""What every test shares: the options, the reference problems, a headless matplotlib."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import TypeVar

import hypothesis
import pytest

from glid_nb import enable_compilation_cache

Report = TypeVar("Report", pytest.CollectReport, pytest.TestReport)

os.environ.setdefault("MPLBACKEND", "agg")
# Compiling a JAX program can take longer than hypothesis' deadline for one example. In
# continuous integration the examples are the same on every run.
hypothesis.settings.register_profile("default", deadline=None)
hypothesis.settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
hypothesis.settings.load_profile("ci" if os.environ.get("CI") else "default")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--no-skip",
        action="store_true",
        help="a test that would be skipped fails instead",
    )
    parser.addoption(
        "--minutes",
        type=float,
        default=0.0,
        help="length of the tests marked `long`, which are left out without it",
    )
    parser.addoption(
        "--install",
        action="store_true",
        help="run the tests marked `install` too, which need the package index",
    )
    parser.addoption(
        "--reference",
        metavar="DIR",
        default=os.environ.get("GLID_NB_REFERENCE"),
        help="folder with the reference problems (default: $GLID_NB_REFERENCE); without it the "
        "tests marked `reference` are left out",
    )


def pytest_configure(config: pytest.Config) -> None:
    """All processes of a run share what they compile, and so do runs one after the other."""
    cache = getattr(config, "cache", None)  # absent with -p no:cacheprovider
    if "GLID_NB_CACHE" not in os.environ and cache is not None:
        os.environ["GLID_NB_CACHE"] = str(cache.mkdir("glid_nb"))
    # Editors save their work there. The user's own files are not touched.
    kept = tempfile.TemporaryDirectory(prefix="glid_nb-", ignore_cleanup_errors=True)
    config.add_cleanup(kept.cleanup)
    os.environ["GLID_NB_DATA"] = kept.name


@pytest.fixture
def minutes(request: pytest.FixtureRequest) -> float:
    """How long a test marked `long` may take."""
    return float(request.config.getoption("--minutes") or 0)


@pytest.fixture(scope="session", autouse=True)
def _compilation_cache() -> None:
    enable_compilation_cache()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    # Browser tests come first: one process takes them, and the others work meanwhile.
    items.sort(key=lambda item: item.get_closest_marker("browser") is None)
    options = {"reference": "--reference", "long": "--minutes", "install": "--install"}
    wanted = {name: config.getoption(option) for name, option in options.items()}
    unwanted = [name for name, value in wanted.items() if not value]
    left_out = [item for item in items if any(map(item.get_closest_marker, unwanted))]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


def _fail_if_skipped(config: pytest.Config, report: Report) -> Report:
    if config.getoption("--no-skip") and report.skipped and not hasattr(report, "wasxfail"):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
        report.outcome = "failed"
        report.longrepr = f"skipped, which --no-skip forbids: {reason}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    return _fail_if_skipped(item.config, report)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    return _fail_if_skipped(collector.config, report)


@pytest.fixture(scope="session")
def reference_folder(request: pytest.FixtureRequest) -> Path:
    """The folder of the reference problems; for tests marked ``reference``."""
    folder = Path(str(request.config.getoption("--reference")))
    assert folder.is_dir(), f"--reference names {folder}, which is not a folder"
    return folder
