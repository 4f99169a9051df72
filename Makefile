# Two commands do the job on a machine with Python and make: `make demo` and `make test`. `make site` opens the site,
# `make docs` builds the pages, `make test-all` runs the long ends of the sweeps as well, `make test-share` a share of them.
# PYTHON chooses the interpreter, at least 3.11.

PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo site test test-all test-share test-clients test-plain golden docs style lint wheel wheel-test lock lock-test sbom audit clean
.DEFAULT_GOAL := demo

# A stamp for each extra, all in one environment: a command installs what it still lacks, the package with its extras at once.
# Renewed when the requirements change; edited code needs no reinstallation. uv takes a fifth of pip's time; pip does it where
# uv cannot, or where pip is told of an index, which uv does not read. Libraries are compiled by all processors, without their
# tests; the package itself is compiled while the network is waited for.
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
UV := $(BIN)/uv pip install --quiet --python $(BIN)/python
define install
$(BIN)/python -m compileall -qq coursework & \
{ ! $(BIN)/python -m pip config list | grep -q '[.:]index-url' && $(PIP) uv && $(UV) --editable '.$(1)'; } \
	|| $(PIP) --editable '.$(1)'; code=$$?; wait; exit $$code
$(BIN)/python -m compileall -qq -j 0 -x '/(tests?|pip|setuptools|pkg_resources|pygments)/' $(VENV)/lib || true
touch $(VENV)/ready $@
endef

$(VENV)/made: pyproject.toml
	@test -n "$(PYTHON)" || { echo "Python 3.11 or newer is needed; none was found. Try: make PYTHON=/path/to/python"; exit 2; }
	$(PYTHON) -m venv $(VENV)
	touch $@

$(VENV)/ready: $(VENV)/made
	$(call install,)

$(VENV)/ready-%: $(VENV)/made
	$(call install,[$*])

demo: $(VENV)/ready  ## The whole job on a class of twelve
	$(BIN)/coursework demo --out demo

# SITE says more of it: make site SITE="--db marks.db --port 8080"; without a word, the class of twelve.
SITE ?= --demo

site: $(VENV)/ready-site  ## The site on this machine, opened in the browser
	$(BIN)/coursework serve --open $(SITE)

# Workers read what another has compiled, even where the user's Python writes none of it.
PYTEST := PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n auto --dist worksteal -q

# Of each sweep over seeds, exercises or languages the first few: see tests/sweeps.py.
test: $(VENV)/ready-test style  ## Every promise on a handful of exercises and on those that differ from the main branch
	$(PYTEST) -m "not slow and not sweep and not e2e"

test-all: $(VENV)/ready-test $(VENV)/ready-e2e style  ## Every test, sweeps at full length
	$(PYTEST)

# Each commit names one of sixty-four shares by its own digits.
SHARE ?= $(shell printf '%d/64' "$$((0x$$(git rev-parse --short=7 HEAD) % 64))")

# What test has, an eighth of the whole commands and of the tests with other programs, a part in 32 of the sweeps over exercises
# and one in 64 of their long ends. Tests with other programs wait for these: there is one worker more than processors.
test-share: $(VENV)/ready-test $(VENV)/ready-e2e style  ## Every promise, and a share of the sweeps that changes with each commit
	$(subst auto,$$(($$(getconf _NPROCESSORS_ONLN) + 1)),$(PYTEST)) --share $(SHARE)

# CLIENTS names what no registry has: make test-clients CLIENTS="--moodle ../moodle --qti-sdk ../qti-sdk"
test-clients: $(VENV)/ready-test $(VENV)/ready-e2e  ## Exports in the real players and platforms that can be set up here
	$(BIN)/python tests/clients/run.py $(CLIENTS)

# The tests of the numeric core, where a last bit would show.
NUMBERS := kinematics mechanics structure course/test_draws.py quantities/test_graph.py scenes/test_scenes.py

# The vector units that numpy has found here and would use; nothing where it names none.
VECTOR_UNITS := import numpy; print(*numpy.show_config('dicts').get('SIMD Extensions', {}).get('found', []))

# numpy, the C library and the linear algebra compute as on a processor without vector units, so that last bits
# differ. A library passes over a word that it does not know.
test-plain: $(VENV)/ready-test  ## The numbers once more, with other last bits
	NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c "$(VECTOR_UNITS)")" OPENBLAS_CORETYPE=Nehalem \
	GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable \
	$(PYTEST) -m "not slow and not sweep and not e2e" $(NUMBERS:%=tests/%)

# The oldest numpy that pyproject.toml allows, in a folder that goes before what is installed.
OLDEST := numpy==1.26.0 scipy==1.11.1
BUILT := --variants 3 --formats pdf,html,ipynb,tex --lang fr,en

# Python 3.11 or 3.12, for which there is such an old numpy.
golden: $(VENV)/ready  ## The same bytes of a build by the oldest and the newest numpy
	rm -rf build/golden
	$(PIP) --no-deps --target build/golden/oldest $(OLDEST)
	PYTHONPATH=build/golden/oldest $(BIN)/python -P -c "import numpy; print('numpy', numpy.__version__)"
	PYTHONPATH=build/golden/oldest $(BIN)/python -P $(BIN)/coursework build $(BUILT) --out build/golden/one
	$(BIN)/coursework build $(BUILT) --out build/golden/two
	diff -r build/golden/one build/golden/two

# A warning is an error. The gallery is made from the course, beside a copy of the sources.
docs: $(VENV)/ready-docs  ## The documentation, in build/site
	rm -rf build/docs build/site
	mkdir -p build
	cp -r docs build/docs
	$(BIN)/python docs/gallery.py build/docs/gallery
	$(BIN)/python docs/import_graph.py build/docs/gallery/rooms.svg
	$(BIN)/sphinx-build -W --keep-going -q -b html -d build/doctrees build/docs build/site
	@echo "open build/site/index.html"

# The same sources give the same bytes: dated by the commit, and no file is looked at outside the sources.
wheel: $(VENV)/ready-test  ## The wheel, in dist, and its digest
	SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct 2>/dev/null || echo 1580601600) \
	$(BIN)/python -m build --quiet --no-isolation --wheel --outdir dist .
	cd dist && sha256sum *.whl

# What a wheel could lack are files: all are compared with the repository, then the demonstration and the first page of its
# site are made from the wheel alone.
wheel-test: $(VENV)/ready-test  ## The wheel has every file and does the job
	rm -rf build/wheel
	mkdir -p build/wheel/unpacked
	$(BIN)/python -m build --quiet --no-isolation --wheel --outdir build/wheel .
	$(BIN)/python tests/wheel_contents.py build/wheel/*.whl
	$(BIN)/python -m zipfile -e build/wheel/*.whl build/wheel/unpacked
	cd build/wheel && PYTHONPATH=unpacked ../../$(BIN)/python -P -m coursework demo --out demo
	cp tests/first_page.py build/wheel/
	cd build/wheel && PYTHONPATH=unpacked ../../$(BIN)/python -P first_page.py

# What a server installs, with digests, for each Python and system: all.txt decides each version, the others follow it.
# The versions that stand there stay while they fit pyproject.toml: make lock UPGRADE=--upgrade takes the newest.
EXTRAS := accuracy cluster nbgrader parquet scan
UPGRADE ?=
COMPILE = $(BIN)/uv pip compile pyproject.toml --quiet --universal --python-version 3.11 --generate-hashes \
	--no-emit-index-url --no-emit-find-links --custom-compile-command "make lock" $(UPGRADE)

lock: $(VENV)/ready-supply  ## The lock files, in locks
	$(COMPILE) --all-extras --output-file locks/all.txt
	$(COMPILE) --no-annotate --constraints locks/all.txt --extra site --extra lti --output-file locks/site.txt
	set -e; for extra in $(EXTRAS); do \
		$(COMPILE) --no-annotate --constraints locks/all.txt --extra $$extra --output-file locks/$$extra.txt; \
	done

# As on a server: what the lock file names and nothing else, then the wheel, which brings nothing.
lock-test: wheel  ## The site from its lock file, in an environment of its own
	rm -rf build/locked
	$(PYTHON) -m venv build/locked
	build/locked/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r locks/site.txt
	build/locked/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-index dist/*.whl
	build/locked/bin/python -m pip check
	cd build/locked && bin/python -P -c "import coursework.site.server, coursework.site.lti.service" && bin/coursework list | tail -1

sbom: $(VENV)/ready-supply  ## The inventory of what the site installs, in build
	$(BIN)/python locks/sbom.py locks/site.txt build/site.cdx.json

audit: $(VENV)/ready-supply  ## Known vulnerabilities of what the site installs; asks the package index
	$(BIN)/pip-audit --require-hashes --disable-pip -r locks/site.txt

style: $(VENV)/ready-test  ## Names, imports and layout
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

lint: $(VENV)/ready-e2e style  ## And the types, which the tests with other programs check as well
	$(BIN)/mypy

clean:
	rm -rf $(VENV) demo build dist .pytest_cache .ruff_cache .mypy_cache .hypothesis
