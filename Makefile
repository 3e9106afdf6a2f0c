# `make demo` and `make test` need Python 3.11+ and make, nothing else.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
# What `make demo` needs: a third of the packages of the tests.
LIGHT  := $(VENV)/.installed-demo
# Python may keep the bytecode of what it imports, else every process of the tests compiles 2400 modules again (8 s).
unexport PYTHONDONTWRITEBYTECODE
# uv where there is one. Bytecode is not made while installing: Python makes that of the fifth that is imported.
UV     := $(shell command -v uv 2>/dev/null)
ifdef UV
INSTALL := VIRTUAL_ENV=$(VENV) $(UV) pip install --quiet
else
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
endif

.PHONY: demo test test-slow test-browser lint docs bench clean
.DEFAULT_GOAL := test

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "treadload needs Python 3.11 or newer; run: make PYTHON=/path/to/python3.11 $(MAKECMDGOALS)" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(STAMP): pyproject.toml constraints.txt | $(BIN)/python
	$(INSTALL) -c constraints.txt -e '.[scan,dev]'
	@touch $@ $(LIGHT)

$(LIGHT): pyproject.toml constraints.txt | $(BIN)/python
	$(INSTALL) -c constraints.txt -e '.[scan]'
	@touch $@

demo: $(LIGHT)
	$(BIN)/treadload demo --output demo

# Two processes test: threads of linear algebra in each would wait for one another, and take twice as long.
test test-slow test-browser: export OMP_NUM_THREADS := 1

# Each process keeps to its files, whose fixtures are solved once.
test: $(STAMP)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not slow and not browser"

test-slow: $(STAMP)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "slow and not browser" $(PYTEST_FLAGS)

# needs Chromium: on Debian `apt-get install chromium`
test-browser: $(STAMP)
	$(BIN)/python -m pytest -m browser

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# The site, in build/docs/index.html; a warning fails.
docs: $(STAMP)
	rm -rf build/docs docs/auto_gallery docs/auto_validation docs/executed
	$(BIN)/python -m sphinx -q -W --keep-going -E -d build/doctrees docs build/docs

bench: $(STAMP)
	$(BIN)/python benchmarks/run_all.py

clean:
	rm -rf $(VENV) demo build dist docs/auto_gallery docs/auto_validation docs/executed .pytest_cache .mypy_cache .ruff_cache
