# Every target sets up .venv by itself; nothing else needs to be installed by hand.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# uv installs in seconds what takes pip a minute; it is used where it is there.
UV := $(shell command -v uv 2>/dev/null)
INSTALL := $(if $(UV),$(UV) pip install --quiet --python $(BIN)/python,$(BIN)/python -m pip install --quiet --disable-pip-version-check)

PROCESSES := 2
# Small matrices gain nothing from threads; two test processes would only fight over the cores.
ONE_THREAD := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 \
	XLA_FLAGS="--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
# What JAX compiles for one test it need not compile for the next, nor in the other process.
KERNELS := JAX_COMPILATION_CACHE_DIR=$(CURDIR)/.pytest_cache/jax JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS=0.5
# What must hold with every version of Python: grids, both solvers, engines.
CORE := tests/material tests/grid tests/simulate tests/fea/test_trial.py tests/mechanics/test_poses.py \
	tests/mechanics/test_topology.py tests/test_native.py tests/test_api.py

.PHONY: demo test test-core packages readers docs lint bench pictures clean

demo: $(VENV)/ready
	mkdir -p out
	$(BIN)/simulearn simulate examples/twist.json -o out/twist.json -o out/twist.png -o out/twist.gif -o out/twist.glb

test: $(VENV)/ready
	$(ONE_THREAD) $(KERNELS) $(BIN)/python -m pytest -n 2 --dist worksteal

# The core of the suite with another Python: make test-core PYTHON=python3.13 VENV=.venv-3.13
test-core: $(VENV)/ready
	$(ONE_THREAD) $(KERNELS) $(BIN)/python -m pytest -n $(PROCESSES) --dist worksteal $(CORE)

# The wheel and the sdist, in fresh environments of each Python outside the checkout; needs uv.
packages: $(VENV)/ready
	SIMULEARN_REQUIRE=uv SIMULEARN_PYTHONS="$(shell .ci/pythons 3.11 3.12 3.13)" \
		$(BIN)/python -m pytest -n $(PROCESSES) --dist worksteal tests/packages

# Programs that read print files, for the tests that ask them; without their servers.
readers: .venv-readers/ready

# The documentation site, in site/.
docs: $(VENV)/ready .venv-docs/ready
	$(BIN)/python docs/site/stage.py build/docs
	.venv-docs/bin/zensical build --strict --clean

lint: $(VENV)/ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/ready
	$(ONE_THREAD) $(BIN)/python benchmarks/verify.py
	$(ONE_THREAD) $(BIN)/python benchmarks/mesh_study.py
	$(ONE_THREAD) $(BIN)/python benchmarks/against_calculix.py
	$(ONE_THREAD) $(BIN)/python benchmarks/speed.py
	$(ONE_THREAD) $(BIN)/python benchmarks/designs.py
	$(ONE_THREAD) $(BIN)/python benchmarks/dataset.py
	$(ONE_THREAD) $(BIN)/python benchmarks/print_time.py
	$(ONE_THREAD) $(BIN)/python benchmarks/learned.py
	$(ONE_THREAD) $(BIN)/python benchmarks/learned_speed.py
	$(ONE_THREAD) $(BIN)/python benchmarks/waiting.py
	$(ONE_THREAD) $(BIN)/python benchmarks/any_grid.py --designs 2000
	$(ONE_THREAD) $(BIN)/python benchmarks/snaps.py --designs 20
	$(ONE_THREAD) $(BIN)/python benchmarks/curve.py
	$(ONE_THREAD) $(BIN)/python benchmarks/inverse.py
	$(ONE_THREAD) $(BIN)/python benchmarks/answers.py
	$(ONE_THREAD) $(BIN)/python benchmarks/studio.py
	$(ONE_THREAD) $(BIN)/python benchmarks/studio_users.py
	$(ONE_THREAD) $(BIN)/python benchmarks/drawings.py
	$(ONE_THREAD) $(BIN)/python benchmarks/hops.py
	$(ONE_THREAD) $(BIN)/python benchmarks/exports.py
	$(ONE_THREAD) $(BIN)/python benchmarks/print_readers.py

# The pictures of README.md and docs/studio.md.
pictures: $(VENV)/ready
	mkdir -p docs/pictures
	$(BIN)/simulearn simulate examples/twist.json -o docs/pictures/twist.gif
	$(BIN)/simulearn simulate examples/random.json -o docs/pictures/random.png
	$(BIN)/python benchmarks/studio_pictures.py
	$(BIN)/python docs/site/tour.py

clean:
	rm -rf .venv .venv-* out build site

$(VENV)/ready: pyproject.toml requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "SimuLearn needs Python 3.11 or newer; name one with: make PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) -r requirements.lock
	$(INSTALL) --no-deps -e .
	touch $(VENV)/ready

.venv-readers/ready: tests/fabricate/readers/requirements.txt
	$(call environment,.venv-readers) --no-deps -r $<
	touch $@

.venv-docs/ready: docs/site/requirements.lock
	$(call environment,.venv-docs) -r $<
	touch $@

# Makes an environment, and begins the command that installs into it.
environment = $(PYTHON) -m venv $(1) && $(if $(UV),$(UV) pip install --quiet --python $(1)/bin/python,$(1)/bin/python -m pip install --quiet --disable-pip-version-check)
