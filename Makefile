# Everything a person or a machine does with this checkout. `make help` lists it.

PYTHON ?= python3
PYTHON_313 ?= python3.13
PORT ?= 8000
FAMILY ?= gaussian
VENV := .venv
BIN := $(VENV)/bin
# Debian's name first; CHROMIUM=/path/to/another takes that one.
WITH_BROWSER = CHROMIUM="$${CHROMIUM:-$$(command -v chromium chromium-browser google-chrome | head -n 1)}"
PIP := $(BIN)/python -m pip --disable-pip-version-check
export PIP_NO_INPUT := 1

.DEFAULT_GOAL := help
.PHONY: help setup run dev check fix test lint lint-python lint-templates lint-js types test-js test-fast \
	test-313 test-without-browser programs chaos load bench mutants new-method lock dist readme-picture clean

help: ## list these targets
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "  make %-15s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(VENV)/.ready ## build .venv with the locked dependencies and the command `microtexture`

run: setup ## serve on http://127.0.0.1:$(PORT), data in ./data
	$(BIN)/microtexture serve --port $(PORT)

dev: setup ## the same, started again when a module of app/ changes; templates and static files are read anew each time
	$(BIN)/uvicorn --factory app.main:create_app --reload --reload-dir app --port $(PORT) --timeout-graceful-shutdown 2

# Every part prints in one piece when it is done, and the others go on when one fails.
check: $(VENV)/.ready-dev node_modules/.ready ## before every commit: lint, types and the fast tests, in half a minute
	@$(MAKE) --no-print-directory --jobs=3 --output-sync=target --keep-going test-fast types lint-js lint-python lint-templates test-js

fix: $(VENV)/.ready-dev node_modules/.ready ## mend what ruff and eslint can mend, and format
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/node node_modules/eslint/bin/eslint.js --fix static/js tests/js
	$(BIN)/node node_modules/prettier/bin/prettier.cjs --write --log-level warn $(SCRIPTS)

# The drivers of browsers, and what is killed on purpose, leave sockets and processes to the garbage collector.
LEFT_OPEN = -W default::ResourceWarning -W default::pytest.PytestUnraisableExceptionWarning

# A machine that nobody watches looks twice before it says that a change broke something, and names what it saw once.
SECOND_LOOK = $(if $(CI),--reruns 1 -rR)

# What kills processes has the machine to itself.
test: $(if $T,$(VENV)/.ready-dev,lint test-js programs) ## all that CI runs, or T=tests/web/test_press.py, a directory or one test
ifdef T
	$(WITH_BROWSER) $(BIN)/pytest $T
else
	$(WITH_BROWSER) $(BIN)/pytest $(SECOND_LOOK) -n 2 --dist loadfile -m 'not (acceptance or chaos or load)'
	$(WITH_BROWSER) $(BIN)/pytest $(LEFT_OPEN) $(SECOND_LOOK) -n 2 --dist loadfile -m 'acceptance and not (chaos or load)' tests
	$(WITH_BROWSER) $(BIN)/pytest $(LEFT_OPEN) $(SECOND_LOOK) -m 'chaos and not load' tests
endif

test-313: ## the tests without a browser on Python 3.13, or on the one that PYTHON_313 names, in an environment of their own
	@PYENV_VERSION=3.13 $(MAKE) --no-print-directory VENV=.venv-3.13 PYTHON=$(PYTHON_313) test-without-browser

test-without-browser: programs
	$(BIN)/pytest -n 2 --dist loadfile -m 'not (acceptance or chaos or load)'
	$(BIN)/pytest $(LEFT_OPEN) -m 'chaos and not (acceptance or load)' tests

test-fast: $(VENV)/.ready-dev
	$(BIN)/pytest -q -n 2 --dist loadfile --hypothesis-profile=quick --testmon --testmon-forceselect -m 'not (slow or acceptance or chaos or load)'

lint: lint-python types lint-templates lint-js ## only what reads the code: ruff, mypy, j2lint and the lint of the scripts

lint-python: $(VENV)/.ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.ready-dev
	$(BIN)/mypy

# S3 wants the nesting shown within the braces, S6 forbids `{%-`, and S7 a condition around a word or an attribute.
lint-templates: $(VENV)/.ready-dev
	$(BIN)/python -m j2lint templates --extensions html --rules_dir lint/templates --ignore S3 S6 S7

SCRIPTS = static/js tests/js lint/promises.js eslint.config.js tsconfig.json package.json
lint-js: node_modules/.ready
	$(BIN)/node node_modules/eslint/bin/eslint.js static/js tests/js
	$(BIN)/node node_modules/prettier/bin/prettier.cjs --check --log-level warn $(SCRIPTS)
	$(BIN)/node node_modules/typescript/bin/tsc
	$(BIN)/node node_modules/typescript/bin/tsc --project tests/js

test-js: node_modules/.ready
	$(BIN)/node --test --test-reporter=dot 'tests/js/*.test.js'

mutants: programs ## break the code in EACH places of every part, one at a time, in a copy, and list what no test notices: an hour
	$(BIN)/python -m scripts.mutants --each $(EACH) $(if $(SEED),--seed $(SEED))

EACH = 60

new-method: $(VENV)/.ready-dev ## the files of a new method to start from: NAME=my-method, FAMILY=sampling (default: gaussian)
	@$(BIN)/python scripts/new_method.py "$(NAME)" --family "$(FAMILY)"

chaos: programs ## the faults of docs/reliability.md at length, for hours: kills by the hundred, outages of a minute
	CHAOS=long $(BIN)/pytest $(LEFT_OPEN) -m chaos

load: $(VENV)/.ready-dev ## only the tests that send sustained load
	$(BIN)/pytest $(LEFT_OPEN) -m load

bench: $(VENV)/.ready-dev ## measure kernels and service on this machine and print one table
	$(BIN)/python -m benchmarks

dist: $(VENV)/.ready-dev ## build both wheels and their source distributions into ./dist
	$(BIN)/python -m hatchling build
	cd app/synthesis && $(abspath $(BIN))/python -m hatchling build --directory $(CURDIR)/dist

readme-picture: programs ## make docs/gallery.png anew with a server and a browser
	$(WITH_BROWSER) $(BIN)/python scripts/readme_picture.py

lock: $(VENV)/.ready-dev ## resolve the dependencies of pyproject.toml anew
	$(BIN)/uv pip compile $(LOCK_OPTIONS) --group build pyproject.toml -o requirements.lock
	$(BIN)/uv pip compile $(LOCK_OPTIONS) --group dev pyproject.toml -c requirements.lock -o requirements-dev.lock

# For every platform and every Python that pyproject.toml admits; `make lock UPGRADE=--upgrade` takes newer versions.
LOCK_OPTIONS = --quiet --no-config --universal --python-version 3.11 --generate-hashes $(UPGRADE) \
	--no-emit-index-url --custom-compile-command "make lock"

clean: ## remove the environment and caches, not ./data
	rm -rf $(VENV) .venv-3.13 node_modules build dist *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis .schemathesis .testmondata*

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
