"""What is around the code: types, documentation, the demo."""

import importlib.resources
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cloudtouch as ct

ROOT = Path(__file__).resolve().parents[3]
PAGES = [ROOT / "docs/python.md", ROOT / "docs/robot.md", ROOT / "crates/python/README.md"]


def test_the_package_has_types():
    assert importlib.resources.files("cloudtouch").joinpath("py.typed").is_file()


def test_the_repository_has_no_compiled_half_of_its_own():
    """One of older sources was there: whoever used the package from a clone got its answers."""
    if not (ROOT / ".git").exists():
        pytest.skip("this is no clone")
    command = ["git", "ls-files", "--", "*.so", "*.pyd", "*.dylib"]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout == ""


def test_the_stub_of_the_compiled_half_says_what_is_there(tmp_path):
    pytest.importorskip("mypy")
    allowed = tmp_path / "allowed.txt"
    # Names of types: those of the stub alone, and one that is looked at as if it were a class.
    allowed.write_text("cloudtouch\\._native\\.(Boxes|Changed|Floats|Found|Pair|Place|Rows|Verdict)\ncloudtouch\\.report\\.Verdict\n")
    command = [sys.executable, "-m", "mypy.stubtest", "cloudtouch", "--allowlist", str(allowed)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_everything_public_is_documented():
    for name in ct.__all__:
        entry = getattr(ct, name)
        if inspect.isclass(entry):
            assert len(inspect.getdoc(entry) or "") > 20, name
            for member, value in vars(entry).items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"


def test_the_reference_is_made_without_a_warning(tmp_path):
    pytest.importorskip("pdoc")
    command = [sys.executable, "-W", "error", "-m", "pdoc", "cloudtouch", "--docformat", "numpy", "-o", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    text = (tmp_path / "cloudtouch.html").read_text(encoding="utf-8")
    assert "The search ends when a collision is this certain" in text and "Where the surfaces touch" in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_example_runs_and_prints_what_it_says(page):
    """Blocks of a page are one program; a text block after one is what it prints."""
    if not page.is_file():
        pytest.skip(f"{page} is not there: the tests are run outside of the repository")
    names, printed, compared = {}, None, 0
    for language, block in re.findall(r"```(\w+)\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL):
        if language == "python":
            lines = []
            names["print"] = lambda *words, lines=lines: lines.append(" ".join(map(str, words)))
            exec(compile(block, str(page), "exec"), names)
            printed = lines
        elif language == "text" and printed is not None:
            assert "\n".join(printed) + "\n" == block
            printed, compared = None, compared + 1
    assert compared


def test_the_demo_goes_from_free_to_collision():
    run = subprocess.run([sys.executable, "-m", "cloudtouch.demo"], capture_output=True, text=True, check=True)
    rows = [line.split() for line in run.stdout.splitlines() if re.match(r"\s+[+-]\d+ ", line)]
    assert [int(row[0]) for row in rows] == sorted((int(row[0]) for row in rows), reverse=True)
    assert rows[0][2] == "free" and rows[-1][2] == "in_collision"
    assert float(rows[0][1]) < 0.01 and float(rows[-1][1]) > 0.99 and len(rows) == 10
