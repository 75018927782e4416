# Sheets of a course project in the theory of mechanisms and machines. "make help" lists what can be made.

PYTHON ?= python3
PROJECT ?= lugansk/shaper
VENV := .venv
BIN := $(VENV)/bin
OUT := out/$(subst /,-,$(PROJECT))
PYTEST = $(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder
SITE := .venv-site
OLDEST := .venv-oldest
SOURCES := $(shell find tmm_sheets templates variants -type f -not -name '*.pyc' 2>/dev/null)

.DEFAULT_GOAL := sheets
.PHONY: help sheets test trials attack lint types oldest lock note wheel-test gallery gallery-check note-check gold messages docs figures picture pictures film site clean distclean

sheets: $(OUT)/sheet1.pdf  ## the sheets of PROJECT (default lugansk/shaper) in out/; this is what plain "make" does

$(OUT)/sheet1.pdf: $(VENV)/.installed $(SOURCES)
	$(BIN)/tmm-sheets build $(PROJECT) -o $(OUT)

test: lint  ## everything the tests prove: ruff, mypy beside pytest
	@$(BIN)/mypy & types=$$!; $(PYTEST); tests=$$?; wait $$types && exit $$tests

trials: $(VENV)/.tested  ## the long tests: every project, every language, random students, photographs, kills, clusters
	$(PYTEST) -m 'trial or hypothesis' --hypothesis-profile many

attack: $(VENV)/.tested  ## odd files, words and arguments at every door, counts by kind in out/; CASES=300 SEED=0, in pieces of SECONDS
	nice -n 19 $(BIN)/python -m tests.attack --cases $(or $(CASES),300) --seed $(or $(SEED),0) $(if $(SECONDS),--seconds $(SECONDS)) \
	    --tally out/attacked-$(or $(SEED),0).toml

lint: $(VENV)/.tested  ## style of the code (ruff)
	$(BIN)/ruff check .

types: $(VENV)/.tested  ## types of the code (mypy)
	$(BIN)/mypy

oldest: $(OLDEST)/.made  ## the oldest versions that pyproject.toml allows, in an environment of their own, and the tests of what stands on them
	$(OLDEST)/bin/python -m pytest -W ignore tests/backends tests/note/test_pages.py tests/page/test_serve.py tests/task \
	    tests/output/test_roster.py tests/compare/test_cad_file.py tests/compare/test_photograph.py tests/test_cli.py

lock: $(VENV)/.made  ## tests/lock.txt: the newest versions of today with the hashes of their files, for every Python and system
	$(BIN)/python -m pip install --quiet --disable-pip-version-check "uv>=0.5"
	$(BIN)/uv pip compile --quiet --universal --generate-hashes --no-annotate --python-version 3.11 --extra test --extra frame \
	    --custom-compile-command "make lock" --no-config --output-file tests/lock.txt pyproject.toml

note: $(VENV)/.installed  ## what the explanatory note needs (extra note), into the environment that is there
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[note]'

wheel-test: $(VENV)/.tested  ## build the wheel, install it elsewhere, draw a project with it
	PYTHON=$(PYTHON) bash tests/wheel_test.sh

gallery: $(VENV)/.tested  ## every shipped project, small, on contact sheets in out/gallery
	$(BIN)/python -m tests.gallery

gallery-check: gallery  ## the same; fails when a sheet cannot be drawn, a label finds no free place or reads as something else, a sheet is filled unevenly
	for language in ru uk en; do $(BIN)/python -m tests.labels --ciphers 60 --lang $$language || exit 1; done
	$(BIN)/python -m tests.evenness

note-check: $(VENV)/.tested  ## the notes of every shipped project in three languages, read as a strict teacher reads them; formulas on sheets
	$(BIN)/python -m tests.note.check_notes
	$(BIN)/python -m tests.note.check_notes --lang ru tests/projects/*.toml
	$(BIN)/python -m tests.note.check_pages
	$(BIN)/python -m tests.sheets.equations

gold: $(VENV)/.tested  ## accept the display lists as they are drawn now (look at the sheets first)
	$(BIN)/python -m tests.sheets.gold

messages: $(VENV)/.tested  ## collect the texts of the program into the catalogues of templates/locale, compile them
	$(BIN)/python -m tests.catalogues

docs: $(VENV)/.tested  ## the tables of docs/ that are made from the program
	$(BIN)/python -m tests.docs

figures: $(VENV)/.tested  ## the figures of docs/accuracy.md that take a minute or two, measured here and now
	$(BIN)/python -m tests.figures

picture: sheets  ## the picture of sheet 1 in the READMEs (needs pdftoppm)
	pdftoppm -r 40 -png -gray -singlefile $(OUT)/sheet1.pdf templates/pictures/sheet1

film: $(VENV)/.tested  ## the film of the living sheet in the READMEs
	$(BIN)/python -m tests.film

pictures: $(VENV)/.tested  ## the pictures of the gallery and the tutorial in docs/ (needs pdftoppm)
	$(BIN)/python -m tests.pictures

site: $(VENV)/.installed $(SITE)/.made  ## docs/ as a site in out/site (mkdocs-material, in an environment of its own)
	NO_MKDOCS_2_WARNING=1 PYTHONPATH=. TMM_SHEETS_PYTHON=$(BIN)/python $(SITE)/bin/mkdocs build --strict --quiet

$(SITE)/.made:
	$(PYTHON) -m venv $(SITE)
	$(SITE)/bin/python -m pip install --quiet --disable-pip-version-check "mkdocs-material>=9.5,<10" "mkdocstrings-python>=1.10"
	@touch $@

$(OLDEST)/.made: pyproject.toml tests/oldest.py
	$(PYTHON) -m venv --clear $(OLDEST)
	$(PYTHON) -m tests.oldest > $(OLDEST)/oldest.txt
	$(OLDEST)/bin/python -m pip install --quiet --disable-pip-version-check --constraint $(OLDEST)/oldest.txt --editable '.[test,frame]'
	@touch $@

clean:  ## remove what was made, keep the virtual environment
	rm -rf out dist build .mypy_cache .ruff_cache .pytest_cache .hypothesis

distclean: clean  ## remove the virtual environment as well
	rm -rf $(VENV) $(SITE) $(OLDEST)

help:  ## this list
	@grep -hE '^[a-z-]+:.*  ## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):[^#]*## /\1\t/' | expand -t 14

# The environment: made once, brought up to date when pyproject.toml changes. With LOCKED=1, as in CI, first of all the very files of
# tests/lock.txt; the ranges of pyproject.toml are satisfied then, and what builds the package is among them: nothing else is fetched.

EDITABLE = install --quiet --disable-pip-version-check $(if $(LOCKED),--no-build-isolation --no-index) --editable

$(VENV)/.made:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	    { echo "Python 3.11 or newer is needed; name it: make PYTHON=python3.12" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	@touch $@

# The second target has what the first one has.
$(VENV)/.installed $(VENV)/.tested: $(VENV)/.made $(if $(LOCKED),$(VENV)/.locked) pyproject.toml $(wildcard templates/locale/*/*/*.po)
	$(BIN)/python -m pip $(EDITABLE) '.$(if $(filter %.tested,$@),[test])'
	@touch $(VENV)/.installed $@

# Compiling every module of every library takes as long as all the rest; what is imported is compiled then.
$(VENV)/.locked: $(VENV)/.made tests/lock.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --require-hashes --requirement tests/lock.txt
	@touch $@
