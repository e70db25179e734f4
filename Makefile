# Two commands set everything up: `make study` measures and writes the report, `make test` tests.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STUDY := $(VENV)/installed-study
DEV := $(VENV)/installed-dev
# Without `picking`, as Warp takes 150 MB; where it is missing, the chapter says how to add it.
STUDY_EXTRAS := study,fracture,viz
# A worker per core: one more gains nothing where tests wait for processes, and compiles more. One takes
# all tests that compile for a structure, or else all of a file (tests/conftest.py); the longest first.
WORKERS := $(shell getconf _NPROCESSORS_ONLN)
PYTEST := -m pytest tests -n $(WORKERS) --dist loadfile --no-loadscope-reorder --durations=20

# Installs the project with extras $(2) into the environment $(1), held by the constraints $(3).
# uv takes a quarter of pip's time; where it cannot be had or does not get through, pip does the same.
define install
@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "hem needs Python 3.11 or newer; say which with: make PYTHON=python3.12 ..." >&2; exit 1; }
@$(PYTHON) -c 'import ensurepip' || { echo "this Python has no venv module; on Debian or Ubuntu: apt-get install python3-venv" >&2; exit 1; }
@echo "Setting up $(1) with $(2) (half a minute, or two without uv)"
@test -x $(1)/bin/python || $(PYTHON) -m venv $(1)
@pip="$(1)/bin/python -m pip --disable-pip-version-check --quiet"; \
	$$pip install uv --constraint $(3) && $(1)/bin/uv pip install --quiet --python $(1)/bin/python --editable '.[$(2)]' --constraint $(3) \
	|| $$pip install --editable '.[$(2)]' --constraint $(3)
endef

# Where this is set, every one of some hundred processes would compile all of Python's modules anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help study test test-all demo soak mutants check format peers peers-cpp test-floor docs clean

help:  ## show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

$(STUDY): pyproject.toml constraints.txt
	$(call install,$(VENV),$(STUDY_EXTRAS),constraints.txt)
	@$(BIN)/python -c 'import sys, hem.sources.meshlab; sys.exit(hem.sources.meshlab.problem() or 0)'
	@touch $@

$(DEV): pyproject.toml constraints.txt
	$(call install,$(VENV),dev,constraints.txt)
	@touch $(STUDY) $@

study: $(STUDY)  ## measure what decides the claims, print table 1, write the report
	@$(BIN)/hem study --preset quick
	@$(BIN)/hem table
	@$(BIN)/hem report

test: $(DEV)  ## run the tests, on every core
	@$(BIN)/python $(PYTEST)

test-all: export HEM_TEST := everything
test-all: test  ## run them with every structure and all data

demo: $(STUDY)  ## break some models, for some minutes, and make a page to watch it on
	@$(BIN)/python -m experiments.cli.demo

soak: $(DEV)  ## operate at random on every structure, 100,000 times; break a hundred times
	@$(BIN)/python -m tests.structures.soak
	@$(BIN)/python -m tests.hem.fracture.soak

mutants: $(DEV)  ## inject faults into a copy of the sources; hem check must catch each
	@$(BIN)/python -m experiments.validation.mutants

check: $(DEV)  ## check format, style, types and the way of imports
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
	@$(BIN)/mypy
	@$(BIN)/lint-imports

docs: $(DEV)  ## write the site with tutorials, how-tos and the API
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet
	@echo "Site written. Open file://$(CURDIR)/build/site/index.html"

format: $(DEV)  ## format the code
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

# OpenMesh comes as source, which is compiled and linked on all cores; some come not for every Python.
# What cannot be installed is left out, and named; CGAL and OpenMesh in C++ are measured where Debian's
# libcgal-dev and libopenmesh-dev are.
peers: export CMAKE_BUILD_PARALLEL_LEVEL := $(shell getconf _NPROCESSORS_ONLN)
peers: export LDFLAGS := -flto=auto
peers: $(STUDY)  ## measure other libraries beside ours, and print what came out
	@install="$(BIN)/python -m pip --disable-pip-version-check install"; \
	uv="$(BIN)/uv pip install --python $(BIN)/python"; \
	$$uv --dry-run compas >/dev/null 2>&1 && install="$$uv"; \
	$$install --quiet --editable '.[peers]' --constraint constraints.txt >/dev/null 2>&1 \
	|| for peer in openmesh libigl meshlib compas open3d bpy; do \
		$$install --quiet $$peer --constraint constraints.txt >/dev/null 2>&1; done || true
	@$(BIN)/hem study --peers
	@$(BIN)/hem table --peers

peers-cpp: $(STUDY)  ## the same of the libraries in C++ alone, where their packages are installed
	@$(BIN)/hem study --peers --structure ours --structure cgal --structure openmesh_cpp
	@$(BIN)/hem table --peers

# A requirement `name>=version` as `name==version`, of the project and of what its tests need.
define oldest
import re, sys, tomllib
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
extras = [project["optional-dependencies"][name] for name in sys.argv[1].split(",")]
print(*(re.sub(">=", "==", it) for it in sum(extras, project["dependencies"])), sep="\n")
endef
export oldest

test-floor:  ## run all tests with the oldest versions that are supported
	@test -x $(VENV)-floor/bin/python || $(PYTHON) -m venv $(VENV)-floor
	@$(VENV)-floor/bin/python -c "$$oldest" $(STUDY_EXTRAS),test > $(VENV)-floor/oldest.txt
	@$(VENV)-floor/bin/python -m pip --disable-pip-version-check --quiet install --editable '.[$(STUDY_EXTRAS),test]' --constraint $(VENV)-floor/oldest.txt
	@$(VENV)-floor/bin/python $(PYTEST)

clean:  ## remove everything that was made here, runs excepted
	rm -rf $(VENV) $(VENV)-floor build *.egg-info .mypy_cache .ruff_cache .pytest_cache report/html report/demo
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
