# make study   set up .venv, build the FMUs, drive one driver into out/, 43 drivers into out/paper/
# make test    all tests but the nightly ones      make test-all  those, too
# make lint    formatting, lints, types, imports   make docs      the site into site/
# make build   the FMUs into dist/                 make native    those without Python: dist/native/
# make wheel   the Python package into dist/       make bench     all speeds as JSON
# make faults  tries to break every promise of docs/reliability.md: 10 minutes, a JSON at the end
# make clean   takes away all but .venv and out/
# make lock    the packages of development and CI chosen anew: requirements-dev.txt
#
# Needs make and Python 3.11 or newer; PYTHON=... chooses one. STUDY=... passes options for the one
# driver, e.g. make study STUDY="--seed 7 --set wish.offset_mps=-2"

ifeq ($(OS),Windows_NT)
BIN := .venv/Scripts
PYTHON ?= py -3
else
BIN := .venv/bin
PYTHON ?= $(shell for p in python3.11 python3.12 python3.13 python3.14 python3 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
endif

READY := .venv/.ready
NODE_READY := node_modules/.ready
BUILT := dist/.built
PRETTIER = $(BIN)/node node_modules/prettier/bin/prettier.cjs
PAGE_FILES := "fmu_src/pldf/cockpit/page/**/*.{js,css,html}" "tests/cockpit/javascript/*.mjs"
FMU_SOURCES := $(shell find fmu_src vehicle_models LICENSE -type f \
	-not -path '*/__pycache__/*' -not -path '*.egg-info/*')

.PHONY: help study test test-all lint format docs bench faults build native wheel setup lock clean

help:
	@sed -n '1,/^$$/s/^# \{0,1\}//p' Makefile

study: $(BUILT)
	$(BIN)/pldf study --out out --restart $(STUDY)
	$(BIN)/pldf study paper --out out/paper --restart
	$(BIN)/pldf analyse out/paper --report out/paper/report.html

test: $(READY) $(NODE_READY)
	$(BIN)/python -m pytest -n auto --dist loadfile $(TESTS)

test-all: $(READY) $(NODE_READY)
	$(BIN)/python -m pytest -n auto --dist loadfile -m "nightly or not nightly" $(TESTS)

lint: $(READY) $(NODE_READY)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/node node_modules/typescript/bin/tsc --noEmit
	$(PRETTIER) --check $(PAGE_FILES)

format: $(READY) $(NODE_READY)
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(PRETTIER) --log-level warn --write $(PAGE_FILES)

docs: $(READY)
	$(BIN)/python -m mkdocs build --strict
	$(BIN)/pldf cockpit --export site/drive.html

bench: $(BUILT)
	@$(BIN)/python benchmarks/bench.py

faults: $(READY)
	@$(BIN)/python faults/campaign.py $(FAULTS)

build: $(BUILT)

native: $(READY)
	$(BIN)/pldf build --native --out dist

# With the FMUs as WebAssembly, so that the cockpit needs no compiler where the wheel is installed; and
# without what an earlier build left in build/: setuptools would pack that, too.
wheel: $(READY)
	rm -rf build
	$(BIN)/pldf build --wasm --out fmu_src/pldf/cockpit/page
	$(BIN)/python -m build --wheel --no-isolation --outdir dist

setup: $(READY)

$(BUILT): $(READY) $(FMU_SOURCES)
	$(BIN)/pldf build --out dist
	@touch $@

# Exactly the packages of requirements-dev.txt, each checked against its hash, and no others: the file
# is whole (pyproject.toml, tool.uv, says why nobody asks what they need). Then this one. The stamp
# is written last, so an interrupted set-up is repeated.
$(READY): pyproject.toml requirements-dev.txt
	@test -n "$(PYTHON)" || { echo "make: no Python 3.11 or newer found;" \
		"install one or name it: make PYTHON=/path/to/python3.11 $(MAKECMDGOALS)" >&2; exit 1; }
	$(PYTHON) -c 'import sys; sys.exit(None if sys.version_info >= (3, 11) else \
		"make: " + sys.version.split()[0] + " is too old, Python 3.11 or newer is needed")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --no-deps --require-hashes \
		--requirement requirements-dev.txt
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@touch $@

# What checks the cockpit's JavaScript; Node.js itself comes with .venv.
$(NODE_READY): $(READY) package.json package-lock.json
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/npm ci --silent --no-audit --no-fund
	@touch $@

# The newest packages that pyproject.toml allows, for every system and Python at once.
lock: $(READY)
	$(BIN)/python -m pip install --quiet "uv>=0.13"
	$(BIN)/uv pip compile --quiet --upgrade --universal --python-version 3.11 --generate-hashes \
		--group dev pyproject.toml --custom-compile-command "make lock" --output-file requirements-dev.txt

# Leaves .venv (set-up takes minutes) and the recordings and profiles in out/.
clean:
	rm -rf dist build site .pytest_cache .mypy_cache .ruff_cache .hypothesis .coverage htmlcov
	find . -name __pycache__ -type d -not -path './.venv/*' -prune -exec rm -rf {} +
