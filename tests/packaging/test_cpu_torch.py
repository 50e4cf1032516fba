"""Which PyTorch set-up installs: a CPU build of the configured index, else one of PyTorch's own, else none and why."""

from __future__ import annotations

import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from daemon.cli.cpu_torch import CPU_INDEX
from daemon.cli.install_torch import install_torch
from tests.support.harness import mmmd

ROOT = Path(__file__).parents[2]
GPU = ('nvidia-cublas==13.1.1.3; platform_system == "Linux"', "triton==3.7.1", "cuda-toolkit[cudart]==13.0.2")


def make_wheel(folder: Path, version: str, requires: tuple[str, ...] = (), name: str = "torch") -> None:
    """A wheel without code, whose metadata requires what is named."""
    info = f"{name}-{version}.dist-info"
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {name}",
        f"Version: {version}",
        *(f"Requires-Dist: {r}" for r in requires),
    ]
    files = {
        f"{info}/METADATA": "\n".join(lines) + "\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    files[f"{info}/RECORD"] = "".join(f"{path},,\n" for path in (*files, f"{info}/RECORD"))
    folder.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(folder / f"{name}-{version}-py3-none-any.whl", "w") as wheel:
        for path, text in files.items():
            wheel.writestr(path, text)


def make_index(folder: Path, *builds: tuple[str, tuple[str, ...]]) -> str:
    """The URL of a package index with these builds of torch."""
    for version, requires in builds:
        make_wheel(folder / "torch", version, requires)
    make_wheel(folder / "nvidia-cublas", "13.1.1.3", name="nvidia_cublas")
    for project in ("torch", "nvidia-cublas"):
        (folder / project).mkdir(parents=True, exist_ok=True)
        links = "".join(f'<a href="{w.name}">{w.name}</a>' for w in sorted((folder / project).glob("*.whl")))
        (folder / project / "index.html").write_text(f"<!DOCTYPE html><html><body>{links}</body></html>")
    return folder.as_uri()


@pytest.fixture(scope="module")
def python(tmp_path_factory) -> Path:
    """The interpreter of an environment with the pip of this one, as `make setup` leaves it, and nothing else."""
    folder = tmp_path_factory.mktemp("env")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    pip = importlib.metadata.distribution("pip")
    installed = next(folder.glob("lib/*/site-packages"))
    for name in ("pip", f"pip-{pip.version}.dist-info"):
        shutil.copytree(pip.locate_file(name), installed / name)
    return folder / "bin" / "python"


@pytest.fixture
def old_pip(python) -> Iterator[str]:
    """The version that pip says it has for one test: Debian 12's, which cannot read requirements alone."""
    metadata = next(python.parents[1].glob("lib/*/site-packages/pip-*.dist-info")) / "METADATA"
    text = metadata.read_text()
    metadata.write_text(re.sub(r"(?m)^Version: .*$", "Version: 23.0.1", text))
    yield "23.0.1"
    metadata.write_text(text)


def set_up(python: Path, configured: str, cpu_index: str, *arguments: str, constraint: Path | None = None):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PIP_")}
    environment |= {"PIP_CONFIG_FILE": os.devnull, "PIP_INDEX_URL": configured, "PIP_RETRIES": "0"}
    command = [python, "-m", "daemon.cli.cpu_torch", "--cpu-index", cpu_index, *arguments]
    if constraint is not None:
        command += ["--constraint", constraint]
    done = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)
    versions = dict[str, str]()
    for info in [*python.parents[1].glob("lib/*/site-packages/*.dist-info")]:
        name, _, version = info.name.removesuffix(".dist-info").partition("-")
        versions[name] = version
        if name != "pip":
            shutil.rmtree(info)
    return done, versions.get("torch")


@pytest.mark.long
def test_a_cpu_build_of_the_configured_index_is_taken(python, tmp_path):
    configured = make_index(tmp_path / "public", ("2.13.0", GPU), ("2.13.0+cpu", ()))
    done, version = set_up(python, configured, "file:///nowhere")
    assert done.returncode == 0, done.stderr
    assert version == "2.13.0+cpu" and "from the configured index" in done.stdout


@pytest.mark.long
def test_the_constraint_keeps_out_a_newer_build(python, tmp_path):
    constraint = tmp_path / "constraints.txt"
    constraint.write_text("torch==2.13.0\n")
    configured = make_index(tmp_path / "public", ("2.13.0+cpu", ()), ("2.15.0", GPU))
    done, version = set_up(python, configured, "file:///nowhere", constraint=constraint)
    assert (done.returncode, version) == (0, "2.13.0+cpu"), done.stderr


@pytest.mark.long
def test_a_plain_build_that_requires_nothing_for_gpus_is_a_cpu_build(python, tmp_path):
    configured = make_index(tmp_path / "public", ("2.13.0", ('nvidia-cublas; platform_system == "Windows"',)))
    done, version = set_up(python, configured, "file:///nowhere")
    assert (done.returncode, version) == (0, "2.13.0"), done.stderr


@pytest.mark.long
def test_pytorchs_own_index_comes_next(python, tmp_path):
    """A plain `torch` of the public index brought 15 GPU packages, 5.9 GB, where the README promised 2 GB."""
    configured = make_index(tmp_path / "public", ("2.13.0", GPU), ("2.15.0", GPU))
    done, version = set_up(python, configured, make_index(tmp_path / "cpu", ("2.13.0+cpu", ())))
    assert done.returncode == 0, done.stderr
    assert version == "2.13.0+cpu" and "/cpu" in done.stdout


@pytest.mark.long
@pytest.mark.parametrize("cpu_index_has", [(), pytest.param((("2.13.0", GPU),), marks=pytest.mark.long)])
def test_without_a_cpu_build_it_stops_and_says_what_would_come(cpu_index_has, python, tmp_path):
    configured = make_index(tmp_path / "public", ("2.13.0", GPU))
    done, version = set_up(python, configured, make_index(tmp_path / "cpu", *cpu_index_has))
    assert (done.returncode, version) == (1, None)
    for said in (
        "nvidia-cublas",
        "cuda-toolkit",
        "6 GB",
        "TORCH=gpu",
        "mmmd install-torch --gpu",
        "--generator",
        "nothing was",
    ):
        assert said in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.long
def test_the_gpu_build_comes_when_it_is_asked_for(python, tmp_path):
    configured = make_index(tmp_path / "public", ("2.13.0", GPU[:1]))
    done, version = set_up(python, configured, "file:///nowhere", "--build", "gpu")
    assert (done.returncode, version) == (0, "2.13.0"), done.stderr


@pytest.mark.long
def test_a_machine_without_any_build_is_named(python, tmp_path):
    """A 32-bit Raspberry Pi OS: pip finds no version of torch at all."""
    done, version = set_up(python, make_index(tmp_path / "public"), make_index(tmp_path / "cpu"))
    assert (done.returncode, version) == (1, None)
    assert "none for Python" in done.stderr and "--generator tcp://HOST:5874" in done.stderr


@pytest.mark.long
def test_an_old_pip_is_named_and_the_index_is_not_blamed(python, old_pip, tmp_path):
    """Debian 12's pip was never asked for the index's build, and the refusal said that the index had none."""
    configured = make_index(tmp_path / "public", ("2.13.0+cpu", ()))
    done, version = set_up(python, configured, "file:///nowhere")
    assert (done.returncode, version) == (1, None)
    assert f"was not asked: pip {old_pip}" in done.stderr and "pip install --upgrade pip" in done.stderr


@pytest.mark.long
def test_what_is_installed_is_kept(python, tmp_path):
    make_wheel(tmp_path, "2.7.0")
    wheel = tmp_path / "torch-2.7.0-py3-none-any.whl"
    site_packages = next(python.parents[1].glob("lib/*/site-packages"))
    zipfile.ZipFile(wheel).extractall(site_packages)
    done, version = set_up(python, make_index(tmp_path / "public", ("2.13.0", GPU)), "file:///nowhere")
    assert (done.returncode, version) == (0, "2.7.0") and "kept" in done.stdout


def test_the_command_and_the_makefile_use_it():
    assert install_torch.__doc__ and "6 GB" in install_torch.__doc__
    assert CPU_INDEX in mmmd("install-torch", "--help").stdout.replace("\n", "")
    makefile = (ROOT / "Makefile").read_text()
    assert "'pip>=23.2'" in makefile
    assert "-m daemon.cli.cpu_torch --constraint constraints.txt --build $(TORCH)" in makefile
