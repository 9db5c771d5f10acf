# Starts from a bare Python 3.11 or later; everything lives in .venv.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet --no-input
FIND_PYTHON = command -v $(PYTHON) >/dev/null || { echo "there is no $(PYTHON); install Python 3.11 or later, or name yours: make PYTHON=/path/to/python3 ..." >&2; exit 1; }
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

.PHONY: help install demo test check check-long check-pythons bench bench-promises bench-campaign bench-page page-pictures bench-team bench-matrix figures bench-predictor bench-gym check-aarch64 golden fuzz soak mutants mavproxy clean three lock

help:
	@echo "make install   the environment only"
	@echo "make demo      set everything up and play a whole game end to end"
	@echo "make test      set everything up and pass the tests"
	@echo "make check     ruff, mypy strict, import contracts, closed locks"
	@echo "make check-long   the long tests, and every property with five times other examples"
	@echo "make check-pythons   a share of the tests on the later Pythons that this machine has"
	@echo "make bench     what things cost, beside the committed costs, in a quarter of an hour; results go to benchmarks/results/"
	@echo "make bench-promises  aborts, stalled strategies, blocked disks, floods: what is promised of them, in ten minutes"
	@echo "make bench-campaign  what games of a campaign cost, beside an earlier commit; a quarter of an hour (SHORT=--short: a few games)"
	@echo "make bench-page  the page before a browser, with 200 and 1000 vehicles"
	@echo "make page-pictures  the pictures of docs/page.md again, from games flown for them; five minutes"
	@echo "make figures   the committed tables of games, routes and predictors again, in one sweep"
	@echo "make bench-matrix  every evader against every pursuers' strategy; resumable"
	@echo "make bench-team   teams of pursuers against the paper's rules, computed and flown, hours; resumable"
	@echo "make bench-predictor   the comparison with LSTM and GRU"
	@echo "make bench-gym   steps of learning environments, beside VMAS and PettingZoo's simple_tag"
	@echo "make golden    what whole games, agents and campaigns do, against what was recorded of them"
	@echo "make fuzz      ten million frames and more into the parsers; resumable"
	@echo "make soak      hours of simulated flight with random faults; resumable"
	@echo "make mutants   small changes to the code: do the tests notice? cosmic-ray in an environment of its own"
	@echo "make mavproxy  MAVProxy in an environment of its own (1.2 GB), for its client test"
	@echo "make three     what the page uses of three.js, as one file again (needs npm)"
	@echo "make lock      resolve the dependencies again (needs uv)"

install: $(STAMP)

$(STAMP): locks/all.lock pyproject.toml
	@$(FIND_PYTHON)
	@echo "setting up $(VENV) (a minute or two the first time)"
	@$(PYTHON) locks/install.py $(VENV) locks/all.lock --editable
	@touch $(STAMP)

demo: install
	@$(BIN)/sim-bridge planar
	@echo
	@log=$$(mktemp); nice $(BIN)/sim-bridge planar --figures figures > "$$log" 2>&1 & drawing=$$!; \
	  $(BIN)/sim-bridge fly first && { wait $$drawing || { cat "$$log"; exit 1; }; }
	@echo
	@echo "figures of the plane games are in figures/. What to try next:"
	@echo "  $(BIN)/sim-bridge fly --fast one-on-one      the same in a few seconds, on virtual time"
	@echo "  $(BIN)/sim-bridge scenario new mine.toml     a scenario of your own"
	@echo "  $(BIN)/sim-bridge serve demo                 and beside it: $(BIN)/gcs"

test: install
	$(BIN)/python -m pytest -n 3 --dist worksteal

check: install
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python locks/closed.py

check-long: install
	$(BIN)/python -m pytest -m long -n 2 --dist worksteal --timeout 1200
	for seed in 1 2 3 4 5; do \
	  HYPOTHESIS_PROFILE=long $(BIN)/python -m pytest -m hypothesis -n 2 --dist worksteal --timeout 1200 \
	    --hypothesis-seed $$seed || exit 1; done

check-pythons: install
	@$(BIN)/python -m tests.install.pythons

bench-campaign: install
	$(BIN)/python -m tests.benchmarks.campaign_speed $(SHORT)

# Costs in rounds of a yardstick, beside the committed ones. Fails where a promise is missed or something got slower.
bench: install
	@rm -f benchmarks/results/latest-costs.json
	@status=0; \
	$(BIN)/python -m pytest tests/benchmarks -n 0 --timeout 1800 -o python_files="test_*.py bench_*.py" $(addprefix --ignore=,$(PROMISES)) --benchmark-json benchmarks/results/latest.json || status=1; \
	$(BIN)/python -m tests.benchmarks.compare || status=1; \
	exit $$status

# Real time and real losses: nothing that counts in rounds of a yardstick.
PROMISES := $(patsubst %,tests/benchmarks/bench_%.py,abort abort_real_loss abort_shell blocked_disk floods stalled_strategy)
bench-promises: install
	$(BIN)/python -m pytest $(PROMISES) -n 0 --timeout 1800

# The base install of a single-board computer: wheels only, no compiler. locks/closed.py has shown that the lock
# lacks nothing on aarch64; here every entry finds a wheel for it. pip takes the markers' Python from itself.
check-aarch64: install
	@$(BIN)/python locks/closed.py
	@$(PIP) --quiet install --dry-run --no-deps --require-hashes --only-binary :all: --target .aarch64 \
	  --python-version "$$($(BIN)/python -c 'import sys; print("%d.%d" % sys.version_info[:2])')" \
	  --implementation cp --platform manylinux_2_28_aarch64 --platform manylinux2014_aarch64 -r locks/base.lock
	@echo "the base install resolves to wheels for aarch64"

# PyTorch, for the comparison with LSTM and GRU, in an environment of its own that sees this one's packages.
TORCH := .venv-torch
$(TORCH)/.installed: locks/bench-predictor.in $(STAMP)
	@$(BIN)/python -m venv $(TORCH)
	@$(TORCH)/bin/python -m pip --disable-pip-version-check --quiet --no-input install -r locks/bench-predictor.in
	@$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))' > "$$($(TORCH)/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/apollonius.pth"
	@touch $@

# Resumable: a game that has its row is not played again.
bench-matrix: install
	$(BIN)/python -m tests.benchmarks.matrix

bench-team: install
	$(BIN)/python -m tests.benchmarks.team --seeds 200 --fly 20 --jobs 2
	$(BIN)/python -m tests.benchmarks.team_plane
	$(BIN)/python -m tests.benchmarks.own_air --seeds 200
	$(BIN)/python -m tests.benchmarks.end_game --seeds 60

bench-predictor: install $(TORCH)/.installed
	$(TORCH)/bin/python -m tests.benchmarks.predictor

# VMAS and mpe2 in an environment of their own that sees this one's packages.
GYM := .venv-gym
$(GYM)/.installed: locks/bench-gym.in $(STAMP)
	@$(BIN)/python -m venv $(GYM)
	@$(GYM)/bin/python -m pip --disable-pip-version-check --quiet --no-input install -r locks/bench-gym.in
	@$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))' > "$$($(GYM)/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/apollonius.pth"
	@touch $@

bench-gym: install $(GYM)/.installed
	$(GYM)/bin/python -m tests.benchmarks.bench_gym

# PAGES="games.md tracking.md" makes some of them, PAGES=--stale those whose sources have changed.
figures: install $(TORCH)/.installed
	$(TORCH)/bin/python -m tests.figures $(PAGES)

golden: install
	$(BIN)/python -m tests.golden

fuzz: install
	$(BIN)/python -m tests.fuzz.framing --count 10000000 --seed 1 --resume .fuzz-framing.json
	$(BIN)/python -m tests.fuzz.signing --count 1000000 --seed 1 --resume .fuzz-signing.json
	$(BIN)/python -m tests.fuzz.autopilots --count 10000000 --seed 1 --resume .fuzz-autopilots.json

soak: install
	$(BIN)/python -m tests.soak.endings --games 200 --seed 1
	$(BIN)/python -m tests.soak.run --hours 4 --seed 1 --resume .soak.json

# cosmic-ray, in an environment of its own that sees this one's packages.
MUTANTS := .venv-mutants
$(MUTANTS)/.installed: locks/mutants.in $(STAMP)
	@$(BIN)/python -m venv $(MUTANTS)
	@$(MUTANTS)/bin/python -m pip --disable-pip-version-check --quiet --no-input install -r locks/mutants.in
	@$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))' > "$$($(MUTANTS)/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/apollonius.pth"
	@touch $@

mutants: install $(MUTANTS)/.installed
	$(MUTANTS)/bin/python -m tests.mutants

bench-page: install
	$(BIN)/python -m tests.benchmarks.page

page-pictures: install
	$(BIN)/python -m tests.support.page_pictures

mavproxy: .venv-mavproxy/bin/mavproxy.py

.venv-mavproxy/bin/mavproxy.py: locks/mavproxy.lock
	@$(FIND_PYTHON)
	@echo "setting up .venv-mavproxy (some minutes the first time)"
	@$(PYTHON) locks/install.py .venv-mavproxy locks/mavproxy.lock
	@touch $@

three:
	cd gcs/page/three && npm ci --ignore-scripts --no-audit --no-fund && node node_modules/esbuild/install.js && npm run build && npm run report
	cp gcs/page/three/node_modules/three/LICENSE gcs/page/static/three.LICENSE

lock:
	uv pip compile pyproject.toml --all-extras --group dev --group build --universal --generate-hashes --no-emit-index-url --no-header --no-annotate --python-version 3.11 -q -o locks/all.lock
	uv pip compile pyproject.toml -c locks/all.lock --universal --generate-hashes --no-emit-index-url --no-header --no-annotate --python-version 3.11 -q -o locks/base.lock
	uv run --no-project --with packaging python locks/closed.py --write

clean:
	rm -rf $(VENV) .venv-3.* build dist figures runs .golden
