# Everything runs in .venv, which holds the versions locked in requirements/ and is made when it is first needed.
# `make help` lists the targets.

BIN  := .venv/bin
RUN  := .venv/run.stamp
TEST := .venv/test.stamp
DOCS := .venv/docs.stamp

# More arguments for pytest, as in: make test ARGS="-k grazing"
ARGS :=

# All tests of a file run in one worker, which computes what they share once. Files begin in the order of tests/conftest.py.
PYTEST := $(BIN)/pytest --numprocesses auto --maxprocesses 8 --dist loadfile --no-loadscope-reorder

# Tests start many processes: each would compile every module it imports anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help demo test test-deep test-plain newest check lint types layers format coverage mutants bench docs wheel lock clean distclean

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/\1	\2/p' Makefile | awk -F '\t' '{ printf "make %-10s %s\n", $$1, $$2 }'

demo: $(RUN) ## study the machine of examples/keogh-cole.toml
	$(BIN)/carom study examples/keogh-cole.toml --out demo-output

test: $(TEST) ## run the tests
	$(PYTEST) $(ARGS)

test-deep: $(TEST) ## run the tests with many more cases, and those marked deep
	CAROM_DEEP=1 $(PYTEST) $(ARGS)

# In one process: with several, what most tests call would be compiled first. Kernels of two planes take minutes in this way.
PLAIN := tests/core/laws $(addprefix tests/core/test_,block.py counter.py events.py flow.py friction.py table.py wall.py) tests/core/vector/test_memory.py

newest: $(TEST) ## run tests of the kernels as the newest Numba that installs compiles them by itself
	tools/newest $(PLAIN) $(ARGS)

check: lint types layers ## check style, types and layers

lint: $(TEST) ## check style and formatting
	$(BIN)/ruff check
	$(BIN)/ruff format --check

types: $(TEST) ## check types
	$(BIN)/mypy

layers: $(TEST) ## check that modules import only from the layers below them
	$(BIN)/lint-imports

format: $(TEST) ## format the code and mend what can be mended
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

# What is compiled is not seen: for the lines of the kernels their own tests run without the compiler.
test-plain: $(TEST) ## run the tests of the kernels without the compiler, and report which lines of these they execute
	NUMBA_DISABLE_JIT=1 $(PYTEST) -m "not jit_only" --cov --cov-report= --cov-fail-under=0 tests/core tests/motions/test_ensembles.py
	$(BIN)/coverage report --include='*/carom/core/*' --omit='*/carom/core/compiling/*' --skip-covered --fail-under=80

coverage: test-plain ## run all tests and report what they cover, which takes half as long again as without
	@$(MAKE) --no-print-directory test ARGS="--cov --cov-append --cov-report=term-missing:skip-covered $(ARGS)"

mutants: $(TEST) ## change the core in small ways and see whether its tests notice; needs cosmic-ray
	$(BIN)/python tools/mutants $(ARGS)

bench: $(TEST) ## time carom beside its peers
	$(BIN)/pytest -p benchmark --benchmark-only -o pythonpath=benchmarks benchmarks $(ARGS)

docs: $(DOCS) ## build the documentation; its examples are executed
	rm -rf docs/reference/generated docs/gallery
	$(BIN)/python tools/kernels
	$(BIN)/sphinx-build -E -W --keep-going -j auto docs build/docs $(ARGS)
	@echo "Documentation: $(CURDIR)/build/docs/index.html"

wheel: $(TEST) ## build what would be published, and use the wheel outside of this directory
	tools/distribution

lock: ## lock the dependencies anew; ARGS=--upgrade takes the newest
	tools/lock $(ARGS)

clean: ## remove products and caches
	rm -rf build dist demo-output docs/reference/generated docs/gallery htmlcov .coverage .coverage.* .benchmarks .hypothesis
	rm -rf .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -path ./.venv -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean ## remove the environment as well
	rm -rf .venv

# Stamps: an environment is made anew when its lock file, or how it is made, changes.
$(RUN): requirements/run.txt pyproject.toml tools/environment
	tools/environment requirements/run.txt
	@touch $@

$(DOCS): requirements/docs.txt pyproject.toml tools/environment
	tools/environment requirements/docs.txt
	@touch $(RUN) $@

# requirements/test.txt and docs.txt hold all of requirements/run.txt.
$(TEST): requirements/test.txt pyproject.toml tools/environment
	tools/environment requirements/test.txt
	@touch $(RUN) $@
