# Everything a newcomer needs: `make demo` shows the main job, `make test` proves it. Both set up first.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
PIP_FLAGS ?=
TORCH ?= cpu
export OMP_NUM_THREADS ?= 1
export OMP_WAIT_POLICY ?= passive
export GOMP_SPINCOUNT ?= 3000

.PHONY: help setup demo test test-long check docs format soak clean

help:
	@echo "make demo       set up, start the simulated robot and the daemon, send three commands, show what happened"
	@echo "make test       set up and pass the tests: of every promise one cheap case, and more where they cost little"
	@echo "make test-long  the tests that repeat a promise at length or in further variants: robots, examples, trainings, the wheel"
	@echo "make check      formatting, lint, types, import rules"
	@echo "make docs       the pages of docs/ as a site, in out/site; a warning or a link that leads nowhere is an error"
	@echo "make format     let ruff format the code"
	@echo "make soak       hours of simulated faults, properties on three times the examples (part of neither suite)"
	@echo "make clean      remove the virtual environment and what runs wrote"

setup: $(VENV)/.ready

# The pip of an older Python reads what a package requires only by downloading it, so pip itself is made new enough (daemon/cli/cpu_torch.py).
# torch comes next and alone, in its CPU build (daemon/cli/cpu_torch.py): with it in place nothing else can pull in another one.
# `make setup TORCH=gpu` takes the build of the configured index, on Linux about 6 GB with its GPU libraries.
$(VENV)/.ready: pyproject.toml constraints.txt
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "mmmd needs Python 3.11 or newer, found " + sys.version)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install $(PIP_FLAGS) --quiet --disable-pip-version-check 'pip>=23.2'
	$(BIN)/python -m daemon.cli.cpu_torch --constraint constraints.txt --build $(TORCH) --pip-flags='$(PIP_FLAGS)'
	$(BIN)/python -m pip install $(PIP_FLAGS) --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@

demo: setup
	$(BIN)/mmmd demo --out out/demo

# Tests of daemons wait for real time: four files at once keep two cores busy, no more of them in real time than there are cores
# (tests/conftest.py, tests/realtime_turn.py).
# Their processes may starve on a slow machine, so what failed runs once more by itself, in a still moment, and has to pass then,
# unless the machine itself stood still meanwhile (tests/host_watch.py). Compiled modules are kept whatever the environment says:
# a daemon whose four processes compile theirs at every start takes half as much processor time again.
# `make test` tries one cheap case of every promise, `make test-long` the others; .ci/run runs both (tests/support/sizes.py).
test test-long soak: export PYTHONDONTWRITEBYTECODE =
test-long: WHICH := -m 'long and not soak and not hardware'
define RUN_TESTS
	$(BIN)/python -m pytest $(WHICH) -n 4 --dist loadfile --no-loadscope-reorder || \
	$(BIN)/python -m pytest $(WHICH) --last-failed --last-failed-no-failures none --void-when-held-up -rs
endef

test: setup
	$(RUN_TESTS)

test-long: setup
	$(RUN_TESTS)

check: setup
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright
	$(BIN)/lint-imports

docs: setup
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet -f docs/tools/mkdocs.yml

format: setup
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

# Hours: tests marked `soak`, and every property on three times the examples of the other suites, drawn anew (tests/support/sizes.py).
soak: setup
	$(BIN)/python -m pytest -m 'soak or hypothesis' --hypothesis-profile soak --timeout 0 -s

clean:
	rm -rf $(VENV) out .pytest_cache .ruff_cache .hypothesis
