# Everything a person or a machine does with this checkout. `make help` lists it.

PYTHON ?= python3
PORT ?= 8000
VENV := .venv
BIN := $(VENV)/bin
# Debian's name first; CHROMIUM=/path/to/another takes that one.
WITH_BROWSER = CHROMIUM="$${CHROMIUM:-$$(command -v chromium chromium-browser google-chrome | head -n 1)}"
PIP := $(BIN)/python -m pip --disable-pip-version-check
export PIP_NO_INPUT := 1

.DEFAULT_GOAL := help
.PHONY: help setup run test lint programs chaos load bench lock readme-picture clean

help: ## list these targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-15s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(VENV)/.ready ## build .venv with the locked dependencies and the command `microtexture`

run: setup ## serve on http://127.0.0.1:$(PORT), data in ./data
	$(BIN)/microtexture serve --port $(PORT)

test: lint programs ## everything: lint, types, unit, doctest, API, acceptance and crash tests
	@# What kills processes, and what watches a page, has the machine to itself.
	$(WITH_BROWSER) $(BIN)/pytest -n 2 --dist loadfile -m 'not (acceptance or chaos or load)'
	$(WITH_BROWSER) $(BIN)/pytest tests -m '(acceptance or chaos) and not load'

# S3 wants the nesting shown within the braces, S6 forbids `{%-`, and S7 a condition around a word or an attribute.
lint-templates: $(VENV)/.ready-dev
	$(BIN)/python -m j2lint templates --extensions html --rules_dir lint/templates --ignore S3 S6 S7

lint: lint-templates $(VENV)/.ready-dev node_modules/.ready ## ruff, mypy, j2lint and eslint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/node node_modules/eslint/bin/eslint.js static/js

chaos: programs ## only the tests that kill processes
	$(BIN)/pytest -m chaos

load: $(VENV)/.ready-dev ## only the tests that send sustained load
	$(BIN)/pytest -m load

bench: $(VENV)/.ready-dev ## measure kernels and service on this machine and print one table
	$(BIN)/python -m benchmarks

readme-picture: programs ## make docs/gallery.png anew with a server and a browser
	$(WITH_BROWSER) $(BIN)/python scripts/readme_picture.py

lock: $(VENV)/.ready-dev ## resolve the dependencies of pyproject.toml anew
	$(BIN)/uv pip compile $(LOCK_OPTIONS) --group build pyproject.toml -o requirements.lock
	$(BIN)/uv pip compile $(LOCK_OPTIONS) --group dev pyproject.toml -c requirements.lock -o requirements-dev.lock

# For every platform and every Python that pyproject.toml admits; `make lock UPGRADE=--upgrade` takes newer versions.
LOCK_OPTIONS = --quiet --no-config --universal --python-version 3.11 --generate-hashes $(UPGRADE) \
	--no-emit-index-url --custom-compile-command "make lock"

clean: ## remove the environment and caches, not ./data
	rm -rf $(VENV) node_modules build dist *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis .schemathesis

$(BIN)/python:
	@scripts/check-python "$(PYTHON)"
	$(PYTHON) -m venv $(VENV)

$(VENV)/.ready: requirements.lock pyproject.toml | $(BIN)/python
	@echo "Installing the locked dependencies into $(VENV)"
	@$(PIP) install --quiet --require-hashes -r requirements.lock
	@$(PIP) install --quiet --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/.ready-dev: requirements-dev.lock $(VENV)/.ready
	@echo "Installing what the tests need into $(VENV)"
	@$(PIP) install --quiet --require-hashes -r requirements-dev.lock
	@touch $@

node_modules/.ready: package.json package-lock.json $(VENV)/.ready-dev
	@echo "Installing the development tools of npm into node_modules"
	@PATH="$(CURDIR)/$(BIN):$$PATH" npm ci --silent --no-audit --no-fund --ignore-scripts
	@touch $@

programs: $(VENV)/.ready-dev node_modules/.ready
	@scripts/test-packages
