"""The wheel: what is in it, and that it runs in an empty environment, from another directory, with and without PyTorch."""

from __future__ import annotations

import ast
import json
import os
import shutil
import site
import subprocess
import sys
import zipfile
from pathlib import Path

import msgspec
import pytest
import zmq

from docs.tools.wire_schemas import schemas

pytestmark = pytest.mark.realtime

ROOT = Path(__file__).parents[2]
LEFT_OUT = ("mmm_core.training", "mmm_core.corpus.families", "mmm_core.corpus.phrases", "mmm_core.corpus.prompts")
NEEDS_A_CLONE = (
    "daemon.cli.offline.train",
    "daemon.cli.offline.eval",
    "daemon.bench",
    "mmm_core.evaluation",
)
"""Modules that may import what the wheel leaves out: they say that a clone is needed."""
CLIENT = (zmq, msgspec)
TORCH = ("torch", "torchgen", "safetensors", "tokenizers", "functorch")
"""Folders of the environment that a machine without PyTorch does not have."""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """The wheel, built from a copy of the sources."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    source.mkdir()
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    tracked = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    for name in filter(None, tracked):
        if name.startswith(("tests/", ".")) or not (ROOT / name).exists():
            continue
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_symlink():
            (source / name).symlink_to((ROOT / name).readlink())
        else:
            os.link(ROOT / name, source / name) if _same_disk(folder) else shutil.copy2(ROOT / name, source / name)
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    made = subprocess.run(
        [sys.executable, "-m", "pip", "wheel", ".", "--no-deps", "--no-build-isolation", "--no-index", "-v", "-w", folder],
        cwd=source, env=environment, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert made.returncode == 0, made.stdout[-3000:] + made.stderr[-3000:]
    (folder / "log").write_text(made.stdout + made.stderr)
    return next(folder.glob("*.whl"))


def _same_disk(folder: Path) -> bool:
    return folder.stat().st_dev == ROOT.stat().st_dev


def names(wheel: Path) -> list[str]:
    return zipfile.ZipFile(wheel).namelist()


@pytest.mark.long
def test_it_builds_without_a_warning(wheel):
    """setuptools warned at length of `retarget.robots.*`: data folders that look like packages and were not listed."""
    lines = [line for line in (wheel.parent / "log").read_text().splitlines() if "warning" in line.lower()]
    assert lines == []


@pytest.mark.long
def test_training_and_its_corpus_stay_in_the_repository(wheel):
    found = names(wheel)
    for package in LEFT_OUT:
        assert not [name for name in found if name.startswith(package.replace(".", "/"))]
    assert not [name for name in found if "evaluator" in name and name.endswith(".safetensors")]
    assert not [name for name in found if name.startswith(("tests", "docs"))]
    assert "mmm_core/weights/mmm_compact.safetensors" in found and "retarget/robots/op3/robot.toml" in found


@pytest.mark.long
def test_the_schemas_of_the_wire_are_inside(wheel):
    with zipfile.ZipFile(wheel) as archive:
        for name, schema in schemas().items():
            assert json.loads(archive.read(f"daemon/wire/json_schemas/{name}")) == json.loads(json.dumps(schema))


@pytest.mark.long
def test_the_metadata_says_what_it_is(wheel):
    with zipfile.ZipFile(wheel) as archive:
        text = archive.read(next(n for n in names(wheel) if n.endswith("/METADATA"))).decode()
    head = text.partition("\n\n")[0].splitlines()
    for field in (
        "Project-URL: Paper",
        "Keywords: ",
        "Classifier: Topic ::",
        "Author: ",
        "License-Expression: Apache-2.0",
    ):
        assert any(line.startswith(field) for line in head), field
    always = [line.partition(": ")[2] for line in head if line.startswith("Requires-Dist") and "extra" not in line]
    assert sorted(r.partition(">")[0] for r in always) == ["msgspec", "pyzmq"]
    assert "Provides-Extra: client" in head and "Provides-Extra: run" in head


def imports_of(module: str) -> set[str]:
    """Modules of ours that a module imports, inside functions too, other than for type checking."""
    path = ROOT / module.replace(".", "/")
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    if not path.exists():  # a name in a module
        return set()
    found = set[str]()
    waiting: list[ast.AST] = [ast.parse(path.read_text("utf-8"))]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            waiting += node.orelse
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
        waiting += ast.iter_child_nodes(node)
    return {name for name in found if name.partition(".")[0] in ("mmm_core", "retarget", "daemon", "sim")}


def test_nothing_that_runs_imports_what_the_wheel_leaves_out():
    """From the commands down, whatever a function may import; `train`, `eval` and `bench` say that they need a clone."""
    waiting = [".".join(p.relative_to(ROOT).with_suffix("").parts) for p in (ROOT / "daemon" / "cli").rglob("*.py")] + [
        "daemon.supervisor.supervisor"
    ]
    waiting = [name for name in waiting if not name.startswith(NEEDS_A_CLONE)]
    seen = dict.fromkeys(waiting, "")
    while waiting:
        module = waiting.pop()
        for name in imports_of(module):
            assert not name.startswith(LEFT_OUT), (
                f"{module} imports {name}, which the wheel leaves out ({seen[module]})"
            )
            if name not in seen and not name.startswith(NEEDS_A_CLONE):
                seen[name] = f"{seen[module]} {module}".strip()
                waiting.append(name)
    assert "mmm_core.generate.engine" in seen and "daemon.control.control_loop" in seen


class Environment:
    """An environment with the wheel and some of this one's packages, used from a directory of its own."""

    def __init__(self, folder: Path, wheel: Path, packages: list[Path]) -> None:
        self.home = folder / "elsewhere"
        self.home.mkdir(parents=True)
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / "env"], check=True)
        self.python = folder / "env" / "bin" / "python"
        place = next((folder / "env").glob("lib/*/site-packages"))
        zipfile.ZipFile(wheel).extractall(place)
        for package in packages:
            (place / package.name).symlink_to(package)

    def run(self, *arguments: str, timeout_s: float = 60.0, **environment: str) -> subprocess.CompletedProcess[str]:
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "MMMD"))}
        return subprocess.run(
            [self.python, *arguments], cwd=self.home, capture_output=True, text=True, timeout=timeout_s, check=False,
            env={**clean, **environment},
        )  # fmt: skip

    def mmmd(self, *arguments: str, timeout_s: float = 60.0) -> subprocess.CompletedProcess[str]:
        return self.run("-m", "daemon.cli", *arguments, timeout_s=timeout_s)


def all_packages() -> list[Path]:
    """What is installed here, but for mmmd itself and what hangs on its path."""
    folders = [Path(p) for p in sys.path if p.endswith("site-packages")]
    assert folders, site.getsitepackages()
    return [
        p for folder in folders for p in folder.iterdir()
        if not p.name.startswith(("__editable__", "__editable___mmmd", "mmmd-", "shared.pth", "__pycache__"))
    ]  # fmt: skip


@pytest.fixture(scope="module")
def client_only(wheel, tmp_path_factory) -> Environment:
    """pyzmq and msgspec alone."""
    packages = [Path(str(m.__file__)).parent for m in CLIENT]
    libraries = [p for package in packages for p in package.parent.glob(f"py{package.name}.libs")]
    return Environment(tmp_path_factory.mktemp("client"), wheel, [*packages, *libraries])


@pytest.fixture(scope="module")
def without_torch(wheel, tmp_path_factory) -> Environment:
    packages = {p.name: p for p in all_packages() if not p.name.startswith(TORCH)}
    return Environment(tmp_path_factory.mktemp("without_torch"), wheel, list(packages.values()))


@pytest.fixture(scope="module")
def whole(wheel, tmp_path_factory) -> Environment:
    return Environment(tmp_path_factory.mktemp("whole"), wheel, list({p.name: p for p in all_packages()}.values()))


@pytest.mark.long
def test_the_client_runs_on_pyzmq_and_msgspec_alone(client_only):
    done = client_only.run(
        "-c", "from daemon.client import Client, AsyncClient; print(Client.__name__, AsyncClient.__name__)"
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["Client", "AsyncClient"]
    heavy = client_only.run("-X", "importtime", "-c", "from daemon.client import Client; Client")
    loaded = {line.rpartition("|")[2].strip() for line in heavy.stderr.splitlines()}
    assert not loaded & {"numpy", "mujoco", "torch", "rich", "tyro"}


@pytest.mark.long
def test_the_client_alone_says_how_to_get_the_commands(client_only):
    done = client_only.mmmd("say", "wave")
    assert done.returncode == 1 and "pip install 'mmmd[run]'" in done.stderr and "internal" not in done.stderr
    assert client_only.mmmd("--version").stdout.startswith("mmmd ")


@pytest.mark.long
def test_without_torch_what_needs_none_works_and_the_rest_says_so(without_torch):
    """`mmmd generate` ended in `internal error (ModuleNotFoundError: No module named 'torch')`."""
    generate = without_torch.mmmd("generate", "wave", "--out", "wave.npz")
    assert generate.returncode == 1, generate.stderr
    assert "mmmd install-torch" in generate.stderr and "internal" not in generate.stderr
    assert "reference" in without_torch.mmmd("robot", "list").stdout
    assert without_torch.mmmd("robot", "check", "op3").returncode == 0
    shown = without_torch.mmmd("gesture", "list")
    assert shown.returncode == 0 and "wave_right" in shown.stdout


@pytest.mark.long
def test_the_whole_wheel_generates_from_another_directory(whole):
    made = whole.mmmd("generate", "wave with your right hand", "--out", "wave.npz", "--bvh", "wave.bvh")
    assert made.returncode == 0, made.stderr
    assert (whole.home / "wave.npz").stat().st_size > 10_000 and (whole.home / "wave.bvh").exists()
    told = whole.mmmd("retarget", "wave.npz", "--robot", "op3", "--out", "ticks.npz")
    assert told.returncode == 0, told.stderr
    where = whole.run(
        "-c",
        "import daemon.cli, mmm_core.generate.engine; print(daemon.cli.__file__, mmm_core.generate.engine.__file__)",
    ).stdout
    assert str(ROOT) not in where


@pytest.mark.long
@pytest.mark.parametrize("command", [["train", "tokenizer", "--run", "r"], ["eval", "probes"]])
def test_what_needs_a_clone_says_so(command, whole):
    done = whole.mmmd(*command)
    assert done.returncode == 1 and "clone" in done.stderr and "internal" not in done.stderr, done.stderr
