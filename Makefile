# Two commands for a newcomer: `make demo` and `make test`. Each sets up all it
# needs in .venv; the others are for people who change the code.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.drake_haptics
CORE := $(wildcard drake_haptics/core/*/* drake_haptics/include/*/*) drake_haptics/core/CMakeLists.txt
# All C and C++ but the programs that time other libraries.
FORMATTED = $(shell find drake_haptics/core drake_haptics/include examples tests -name '*.c' -o -name '*.cc' -o -name '*.h')

.PHONY: demo tutorials test test-newest lint unit docs format build wheel core-tests fuzz clean
.DEFAULT_GOAL := demo

demo: $(STAMP)
	$(BIN)/drake-haptics run cup_spoon

# The tutorials in the browser, to be run and changed.
tutorials: $(STAMP)
	$(BIN)/pip install --quiet --disable-pip-version-check "jupyterlab>=4" "coal>=3.0" "pygraphviz>=2.0"
	$(BIN)/jupyter lab docs/tutorials

test: lint unit

# Tests of one file stay together and in order: they share what they have set up, and
# some go on from one another. The longest files come first: see tests/conftest.py.
TESTS ?= tests
unit: $(STAMP)-test
	$(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder $(TESTS)

# What depends on Python and Drake themselves (calls of the core, loop, AutoDiff, device,
# LCM, command line, newer parts of Drake), on the newest CPython of this machine that Drake has a wheel for.
NEWEST_TESTS := $(wildcard tests/core/*/test_*.py tests/loop/test_*.py tests/device/lcm/test_*.py) \
  $(foreach part,device lcm tool,$(wildcard tests/systems/$(part)/test_*.py)) \
  tests/systems/contact/test_contact_query.py tests/device/test_udp_device.py \
  $(foreach part,gradients haptic_rendering continuous_steps hydroelastic mouse_spring nested \
    two_tools_on_an_arm,tests/rendering/test_$(part).py) \
  $(foreach part,cli_run cli_help closed_loop_two_processes lcm_docs model_visualizer, \
    tests/acceptance/test_$(part).py)
test-newest:
	@newest=$$(.ci/newest-python $(PYTHON)) || exit 1; \
	if [ -z "$$newest" ]; then echo "Skipped: the tests on a newer Python."; exit 0; fi; \
	echo "The tests on $$newest:"; \
	$(MAKE) unit VENV=.venv-newest PYTHON="$$newest" TESTS="$(NEWEST_TESTS)"

lint: $(STAMP)-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/clang-format --dry-run -Werror $(FORMATTED)

# The pages of docs/ with the reference that is made of the code, as a site.
docs: $(STAMP)-test
	@echo "Building the site takes some two minutes. Notebooks are shown as saved, not run."
	$(BIN)/python -m sphinx --builder html --jobs auto --quiet --nitpicky \
	  --fail-on-warning --keep-going docs build/docs
	@echo "The front page is $(CURDIR)/build/docs/index.html"
	@echo "For the search to show more than titles: $(BIN)/python -m http.server -d build/docs"

format: $(STAMP)-test
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/clang-format -i $(FORMATTED)

# Rebuilds the C++ core after an edit, without a fresh build environment, and file by
# file: the first time it compiles all of them.
build:
	@test -e $(STAMP)-test || $(MAKE) $(STAMP)-test
	$(BIN)/pip install --quiet "scikit-build-core>=0.11" "nanobind>=2.7,<3" "cmeel-eigen>=3.4"
	$(BIN)/pip install --quiet --no-build-isolation --no-deps \
	  --config-settings=cmake.define.CMAKE_UNITY_BUILD=OFF -e .
	$(BIN)/python -m nanobind.stubgen -q -m drake_haptics._core -o drake_haptics/_core.pyi
	@touch $(STAMP) $(STAMP)-test

# The wheel of PYTHON, and where there is a newer Python that of the stable ABI, in dist/:
# repaired, and tried where there is no compiler. Each compiles the core, some minutes.
wheel:
	.ci/wheel $(PYTHON)
	@newest=$$(.ci/newest-python $(PYTHON)) || exit 1; \
	if [ -n "$$newest" ]; then .ci/wheel "$$newest"; fi

# The core's own tests in C++, under sanitizers and without Python: all of them, or one as
# of CORE_TEST=tracker/supported_facets_test. Only what was edited is compiled again, into the
# folder of tests/core/test_cpp.py, by whose settings it is configured.
CORE_TESTS := build/core_tests
CORE_TEST ?=
core-tests: $(CORE_TESTS)/build.ninja
	$(BIN)/cmake --build $(CORE_TESTS) --target $(or $(notdir $(CORE_TEST)),core_tests)
	$(BIN)/ctest --test-dir $(CORE_TESTS) --output-on-failure --no-tests=error \
	  $(if $(CORE_TEST),--tests-regex '^$(notdir $(CORE_TEST))$$',--label-exclude threads)

$(CORE_TESTS)/build.ninja:
	@test -e $(STAMP)-test || $(MAKE) $(STAMP)-test
	$(BIN)/cmake -S drake_haptics/core -B $(CORE_TESTS) -G Ninja \
	  -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(BIN)/ninja -DCMAKE_BUILD_TYPE=None \
	  -DDRAKE_HAPTICS_TESTS=ON -DDRAKE_HAPTICS_BINDINGS=OFF \
	  -DCMAKE_PREFIX_PATH=$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || { \
	  echo "drake_haptics needs Python 3.10 or newer; '$(PYTHON)' is $$($(PYTHON) --version 2>&1)."; \
	  echo "Name another one: make demo PYTHON=python3.12"; exit 1; }
	@printf '#include <span>\ntemplate <class T> concept Any = true;\nint main() {}\n' > .compiler-check.cc; \
	$${CXX:-c++} -std=c++20 -fsyntax-only .compiler-check.cc >/dev/null 2>&1; ok=$$?; rm -f .compiler-check.cc; \
	if [ $$ok -ne 0 ]; then \
	  echo "drake_haptics needs a C++20 compiler and found none (tried '$${CXX:-c++}')."; \
	  echo "On Debian or Ubuntu: sudo apt-get install g++. On macOS: xcode-select --install."; \
	  echo "Or name one: CXX=clang++ make demo"; exit 1; fi
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); exit 1; }

# The pip of CPython 3.10.0 to 3.10.2 installs no clone for editing, and does not say why.
define check_pip
@$(BIN)/python -c 'import pip, sys; sys.exit([*map(int, pip.__version__.split(".")[:2])] < [21, 3])' || { \
  echo "drake_haptics needs pip 21.3 or newer; run: $(BIN)/python -m pip install --upgrade pip"; \
  exit 1; }
endef

# Without --no-compile, pip compiles eleven thousand files of Python one after the other,
# of which most are never imported; what is imported is compiled then. It tells what it
# does: minutes of silence look like a stop.
$(STAMP): pyproject.toml $(CORE) | $(VENV)/bin/python
	$(check_pip)
	@echo "Setting up $(VENV), $$($(BIN)/python --version): the newest Drake for it, 1.51.1 or later," \
	  "and the C++ core, a few minutes the first time."
	$(BIN)/pip install --disable-pip-version-check --no-compile -e .
	@touch $@

$(STAMP)-test: pyproject.toml $(CORE) | $(VENV)/bin/python
	$(check_pip)
	@echo "Setting up $(VENV), $$($(BIN)/python --version): the newest Drake for it, 1.51.1 or later," \
	  "the C++ core and the test tools, a few minutes the first time."
	$(BIN)/pip install --disable-pip-version-check --no-compile -e ".[test]"
	@touch $@ $(STAMP)

# Fuzzes the core until a fault is found or the time is over; see docs/verification/numerics.md.
FUZZ ?= pair
FUZZ_SECONDS ?= 900
fuzz: $(STAMP)-test
	@command -v clang++ >/dev/null || { \
	  echo "Fuzzing needs clang and its libFuzzer; clang++ was not found."; \
	  echo "On Debian or Ubuntu: sudo apt-get install clang libclang-rt-14-dev"; exit 1; }
	$(BIN)/cmake -S drake_haptics/core -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ \
	  -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(BIN)/ninja -DCMAKE_BUILD_TYPE=None \
	  -DDRAKE_HAPTICS_FUZZERS=ON -DDRAKE_HAPTICS_BINDINGS=OFF \
	  -DCMAKE_PREFIX_PATH=$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
	$(BIN)/cmake --build build/fuzz --target $(FUZZ)_libfuzzer
	mkdir -p build/fuzz/found
	build/fuzz/fuzzers/$(FUZZ)_libfuzzer -max_len=700 -timeout=20 -max_total_time=$(FUZZ_SECONDS) \
	  -artifact_prefix=build/fuzz/found/ build/fuzz/found tests/fuzz/corpus/$(FUZZ)

clean:
	rm -rf $(VENV) .venv-newest build
