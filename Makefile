# make demo   one picture from file to certified deformation, in an environment of its own
# make test   all tests: of this checkout, of the distributions installed in empty environments, and all chapters, in
#               an environment made as the course's page says; GLID_NB_REFERENCE=DIR adds the paper's shapes
# make install-tests  the second and third of these alone; needs the package index
# make unit   the fast tests only
# make pythons  the fast tests, the demo and a chapter on every other Python of this machine, and on
#               the oldest one with the oldest libraries that pyproject.toml allows
# make leaks  half an hour in a browser: memory in long sessions, cells that run again, a new user's walk
# make lint   ruff, pyright, biome and tsc for JavaScript, and the linters of the workflows
# make page   bundles the JavaScript of glid_nb/page anew; make page-tests tests it
# make dev    the development environment with everything
# make compare  the paper's comparisons measured anew; ARGUMENTS=--help tells more
# make bench  the solver's speed on this machine; ARGUMENTS=--help likewise
# make gpu    the solver on this machine's GPU (at most 8 minutes), with the machine's own Python and JAX
# make docs   the site in site/, checked: pages, links, and each page in Chromium
# make notebooks  all chapters, run in place and saved; ARGUMENTS="03 07" runs these two
# make student  the student edition of the course in student/, without solutions
# make slides  six lectures in slides/, from the chapters' own cells
# make browser  Chromium and Firefox for the browser tests, by apt
# The environment is made with the newest Python that tools/pythons.sh finds, or with $PYTHON; another
# one beside it: make unit VENV=.venv-3.12 PYTHON=python3.12
SHELL := /bin/sh
export VENV := .venv
PYTEST := $(VENV)/bin/python -m pytest
# One more than there are processors: tests that wait for the browser or a kernel leave theirs idle.
WORKERS = $(shell expr $$(nproc) + 1)

# Without bytecode every process of the tests compiles the package and the test files anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test unit page page-tests install-tests pythons chapter leaks lint format dev compare bench gpu docs notebooks student slides browser clean
.DEFAULT_GOAL := demo

demo: $(VENV)/.demo
	$(VENV)/bin/glid-nb demo --out glid-nb-demo

# --no-skip: a test that would be skipped because something is missing fails instead. The tests marked
# `install` need the package index.
test: $(VENV)/.test browser page-tests
	$(PYTEST) -p no:nbval --no-skip -n $(WORKERS) --dist worksteal --durations 25
	$(MAKE) install-tests

# Needs node, which the extra `page` brings; all else uses the bundles that lie in the repository.
page: node_modules/.package-lock.json
	tools/npm.sh run --silent build

page-tests: node_modules/.package-lock.json
	tools/npm.sh test --silent

unit: $(VENV)/.test
	$(PYTEST) -p no:nbval --no-skip -m "not slow and not browser" -n auto tests

pythons:
	tools/other_pythons.sh

chapter: $(VENV)/.test
	$(PYTEST) --nbval --nbval-current-env notebooks/01_quickstart.ipynb

install-tests: $(VENV)/.test
	$(PYTEST) -p no:nbval --no-skip --install -m install -n $(WORKERS) --dist loadgroup --durations 5 tests/packaging

leaks: $(VENV)/.test browser
	$(PYTEST) -p no:nbval --no-skip -s --minutes 10 -m long tests/widgets

lint: $(VENV)/.dev node_modules/.package-lock.json
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/pyright --pythonpath $(VENV)/bin/python
	tools/npm.sh run --silent lint
	$(VENV)/bin/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml
	$(VENV)/bin/check-jsonschema --builtin-schema vendor.dependabot .github/dependabot.yml
	$(VENV)/bin/zizmor --offline --quiet .github

format: $(VENV)/.dev node_modules/.package-lock.json
	$(VENV)/bin/ruff check --fix .
	$(VENV)/bin/ruff format .
	tools/npm.sh run --silent format

dev: $(VENV)/.dev

compare: $(VENV)/.studies
	$(VENV)/bin/python -m studies compare $(ARGUMENTS)

bench: $(VENV)/.studies
	$(VENV)/bin/python -m studies bench $(ARGUMENTS)

gpu:
	tools/gpu.sh $(ARGUMENTS)

docs: $(VENV)/.docs
	rm -rf site build/doctrees
	$(VENV)/bin/sphinx-build -q -b html -W --keep-going -c docs -d build/doctrees . site
	tools/chromium.sh
	$(VENV)/bin/python tools/check_site.py site

notebooks: $(VENV)/.test
	$(VENV)/bin/python tools/run_notebooks.py $(ARGUMENTS)

student: $(VENV)/.test
	$(VENV)/bin/python tools/student_edition.py $(ARGUMENTS)

slides: $(VENV)/.test
	$(VENV)/bin/python tools/slides.py $(ARGUMENTS)

browser:
	tools/chromium.sh
	tools/firefox.sh

# The stamps say what the environment holds; pyproject.toml newer than a stamp installs again.
$(VENV)/.demo: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh
	touch $@

$(VENV)/.studies: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh studies
	touch $@ $(VENV)/.demo

$(VENV)/.test: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh test
	touch $@ $(VENV)/.studies $(VENV)/.demo

$(VENV)/.docs: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh docs
	touch $@ $(VENV)/.demo

$(VENV)/.dev: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh dev
	touch $@ $(VENV)/.test $(VENV)/.docs $(VENV)/.page $(VENV)/.studies $(VENV)/.demo

$(VENV)/.page: pyproject.toml checker/pyproject.toml tools/environment.sh tools/pythons.sh
	tools/environment.sh page
	touch $@ $(VENV)/.demo

node_modules/.package-lock.json: package.json package-lock.json | $(VENV)/.page
	tools/npm.sh ci
	touch $@

clean:
	rm -rf $(VENV) node_modules glid-nb-demo artefacts build dist site student slides
