# Starts from a bare Python 3.11 or later; everything lives in .venv.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet --no-input
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

.PHONY: help install demo test check bench clean lock

help:
	@echo "make install   the environment only"
	@echo "make demo      set everything up and play a whole game end to end"
	@echo "make test      set everything up and pass the tests"
	@echo "make check     ruff, mypy strict, import contracts"
	@echo "make bench     benchmarks; results go to benchmarks/results/"
	@echo "make lock      resolve the dependencies again (needs uv)"

install: $(STAMP)

$(STAMP): locks/all.lock pyproject.toml
	@echo "setting up $(VENV) (a minute or two the first time)"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed, this is " + sys.version.split()[0])'
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) install --require-hashes -r locks/all.lock
	@$(PIP) install --no-deps --no-build-isolation -e .
	@touch $(STAMP)

demo: install
	@$(BIN)/sim-bridge planar --figures figures
	@echo
	@echo "Figures of every game are in figures/. Try: $(BIN)/sim-bridge planar --help"

test: install
	$(BIN)/python -m pytest -n 2 --dist worksteal

check: install
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: install
	$(BIN)/python -m pytest tests/benchmarks -n 0 --timeout 1800 --benchmark-json benchmarks/results/latest.json

lock:
	uv pip compile pyproject.toml --all-extras --group dev --group build --universal --generate-hashes --no-emit-index-url --no-header --python-version 3.11 -q -o locks/all.lock
	uv pip compile pyproject.toml -c locks/all.lock --universal --generate-hashes --no-emit-index-url --no-header --python-version 3.11 -q -o locks/base.lock

clean:
	rm -rf $(VENV) build dist figures runs
