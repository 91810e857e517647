# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0

# PYTHON=/path/to/python3.x chooses the interpreter; otherwise scripts/find_python.sh does.
export PYTHON
VENV := .venv
PYTHON_BIN := $(VENV)/bin/python
# A sourced /opt/ros/jazzy must not leak into the environment of the wheels.
CLEAN = $(PYTHON_BIN) -E -s -S scripts/clean_environment.py
TOOL = $(CLEAN) $(PYTHON_BIN) -m
# The set-up runs in the environment's own interpreter once there is one: no search then.
BOOTSTRAP = $$(if [ -z "$$PYTHON" ] && $(PYTHON_BIN) -E -s -S -c '' 2>/dev/null; \
	then echo $(PYTHON_BIN); else sh scripts/find_python.sh; fi)
SETUP = python=$(BOOTSTRAP) && "$$python" -E -s -S scripts/setup_environment.py
# All Python code but the tests, launch files and setup.py.
TYPED = $(patsubst %/__init__.py,%,$(filter-out %/test/__init__.py,$(wildcard ros_ws/src/*/*/__init__.py))) \
	scripts benchmarks docs bags/simulate
PYTEST_ARGS ?=
BENCH_ARGS ?=
DEMO_ARGS ?=

.PHONY: help setup setup-dev demo test test-long lint typecheck bench opensim reference-models \
	colcon interfaces lock clean
.DEFAULT_GOAL := help

help: ## show this help
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 14

setup: ## make .venv: locked packages, ROS wheels, interfaces, compiled functions, lift
	@$(SETUP)

setup-dev: ## setup, and the tools of the tests
	@$(SETUP) --dev

demo: setup ## play one recorded lift through the whole graph; leaves out/demo/
	@$(VENV)/bin/lift demo $(DEMO_ARGS)

test: lint typecheck reference-models ## checks and tests (at most 15 minutes on two cores)
	@$(TOOL) pytest $(PYTEST_ARGS)

test-long: setup-dev ## the tests that take longer
	@$(TOOL) pytest -m long --timeout=3600 $(PYTEST_ARGS)

lint: setup-dev ## ruff (rules and format) and codespell over everything
	@$(TOOL) ruff check --quiet .
	@$(TOOL) ruff format --check --quiet .
	@$(TOOL) codespell_lib

typecheck: setup-dev ## mypy, strict, over all packages, scripts, benchmarks and generators
	@$(TOOL) mypy $(TYPED)

bench: reference-models ## speed and accuracy figures
	@test -f benchmarks/run.py || { echo 'there is no benchmarks/run.py' >&2; exit 1; }
	@$(CLEAN) $(PYTHON_BIN) benchmarks/run.py $(BENCH_ARGS)

opensim: ## OpenSim 4.6 into .venv-opensim, for lift compare-opensim and the tests with it
	@python=$(BOOTSTRAP) && "$$python" -E -s -S scripts/setup_opensim.py

# Without them their tests are skipped and say so: a registry that does not answer stops nothing.
reference-models: setup-dev ## models of other groups, for the tests of the model reader
	-@$(CLEAN) $(PYTHON_BIN) scripts/reference_models.py

colcon: setup-dev ## build ros_ws with colcon against the wheels, into build/colcon
	@$(PYTHON_BIN) -E -s -S scripts/colcon_build.py

interfaces: setup ## rebuild the interface package if a message changed (part of setup)

lock: ## resolve requirements/*.in to requirements/*.txt (with the environment's Python)
	@$(CLEAN) $(PYTHON_BIN) scripts/lock_requirements.py

clean: ## remove the environment and everything built
	rm -rf $(VENV) .venv-opensim build install log out .cache .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
