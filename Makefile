# Two commands set everything up: `make study` measures and writes the report, `make test` tests.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/installed
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.DEFAULT_GOAL := help
.PHONY: help study test demo soak mutants check format peers test-floor clean

help:  ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

$(INSTALLED): pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "hem needs Python 3.11 or newer; say which with: make PYTHON=python3.12 ..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip' || { echo "this Python has no venv module; on Debian or Ubuntu: apt-get install python3-venv" >&2; exit 1; }
	@echo "Setting up $(VENV) (a minute or two)"
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@$(PIP) install --editable '.[dev]' --constraint constraints.txt
	@$(BIN)/python -c 'import sys, hem.sources.meshlab; sys.exit(hem.sources.meshlab.problem() or 0)'
	@touch $@

study: $(INSTALLED)  ## measure for some 15 minutes, print table 1, write the report
	@$(BIN)/hem study --profile quick
	@$(BIN)/hem table
	@$(BIN)/hem report

# In the order of the files the slowest tests come first, and the cores end at the same time.
test: $(INSTALLED)  ## run all tests, on every core
	@$(BIN)/python -m pytest tests -n auto --dist loadfile --no-loadscope-reorder

demo: $(INSTALLED)  ## break some models, for two minutes, and make a page to watch it on
	@$(BIN)/python -m experiments.cli.demo

soak: $(INSTALLED)  ## operate at random on every structure, 100,000 times; break a hundred times
	@$(BIN)/python -m tests.structures.soak
	@$(BIN)/python -m tests.hem.fracture.soak

mutants: $(INSTALLED)  ## inject faults into a copy of the sources; hem check must catch each
	@$(BIN)/python -m experiments.validation.mutants

check: $(INSTALLED)  ## check format, style and types
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy

format: $(INSTALLED)  ## format the code
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

peers: $(INSTALLED)  ## compare with OpenMesh, libigl, MeshLib, trimesh and COMPAS
	@$(PIP) install --editable '.[peers]' --constraint constraints.txt
	@$(BIN)/python -m experiments.validation.peers

test-floor:  ## run all tests with the oldest versions that are supported
	@test -x $(VENV)-floor/bin/python || $(PYTHON) -m venv $(VENV)-floor
	@$(VENV)-floor/bin/python -m pip --disable-pip-version-check --quiet install --editable . pytest hypothesis --constraint constraints-floor.txt
	@$(VENV)-floor/bin/python -m pytest tests

clean:  ## remove everything that was made here, runs excepted
	rm -rf $(VENV) $(VENV)-floor build *.egg-info .mypy_cache .ruff_cache .pytest_cache report/html report/demo
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
