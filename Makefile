# libmsr: mass-spring systems in two dimensions. `make help` lists what can be made.

# ---- Settings ------------------------------------------------------------------------------------

## CC=clang CFLAGS=-O2: another compiler, other flags
CFLAGS     ?= -O3 -g
LDFLAGS    ?=
PKG_CONFIG ?= pkg-config
## SAN=address,undefined test: with sanitizers, in a directory of their own
SAN         =
BUILD       = build$(if $(SAN),/san-$(subst $(comma),-,$(SAN)))
## PREFIX=$HOME/.local install: where to install; LIBDIR and DESTDIR too
PREFIX     ?= /usr/local
DESTDIR    ?=
LIBDIR      = $(PREFIX)/lib
DOCDIR      = $(PREFIX)/share/doc/msr
MANDIR      = $(PREFIX)/share/man/man1
## V=1: shows whole commands
V           =

# ---- Flags ---------------------------------------------------------------------------------------

WARNINGS   = -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wvla -Wundef \
             -Wdouble-promotion -Wformat=2 -Wcast-qual -Wwrite-strings -Wpointer-arith
C_WARNINGS = -Wstrict-prototypes -Wmissing-prototypes
LANGUAGE   = -std=c11 -D_POSIX_C_SOURCE=200809L -pthread -Iinclude
# Part of correctness: a state has the same bits with either compiler and any vector width.
ARITHMETIC = -ffp-contract=off -fno-math-errno
SANITIZE   = $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer)

# pkg-config is asked once, when the first command needs it: `make deps` may just have installed it.
GSL_CFLAGS  = $(eval GSL_CFLAGS := $(shell $(PKG_CONFIG) --cflags gsl 2>/dev/null))$(GSL_CFLAGS)
GSL_LIBS    = $(eval GSL_LIBS := $(shell $(PKG_CONFIG) --libs gsl 2>/dev/null))$(GSL_LIBS)

COMPILE     = $(CC) $(LANGUAGE) $(WARNINGS) $(C_WARNINGS) $(CFLAGS) $(ARITHMETIC) $(SANITIZE) \
              -fPIC -fvisibility=hidden
LINK        = $(CC) -pthread $(CFLAGS) $(SANITIZE) $(LDFLAGS)

# ---- Files ---------------------------------------------------------------------------------------

VERSION  := $(shell sed -n 's/^.define MSR_VERSION "\(.*\)"/\1/p' include/msr.h)
# Before 1.0 a minor version may change the interface.
NUMBERS  := $(subst ., ,$(VERSION))
MAJOR    := $(word 1,$(NUMBERS))$(if $(filter 0,$(word 1,$(NUMBERS))),.$(word 2,$(NUMBERS)))
LIB_SRC  := $(wildcard libmsr/*/*.c)
CLI_SRC  := $(wildcard cli/*.c)
TEST_SRC := $(wildcard tests/test_*.c)
FUZZ_SRC := $(wildcard tests/fuzz/fuzz_*.c)
EX_SRC   := $(wildcard examples/*.c)
BITS_SRC := $(wildcard tests/bits/*.c)
BENCH_SRC := $(wildcard tests/bench/*.c tests/bench/*.cc)
HARD_SRC := $(wildcard tests/stability/*.c)
BESIDE_SRC := $(wildcard tests/bench/stability/*.c tests/bench/stability/*.cc)
SPEED_SRC := $(wildcard tests/bench/speed/*.c)
SOURCES  := $(LIB_SRC) $(CLI_SRC) $(TEST_SRC) $(FUZZ_SRC) $(BITS_SRC) $(HARD_SRC) $(BENCH_SRC) \
             $(BESIDE_SRC) $(SPEED_SRC) $(EX_SRC) $(wildcard tests/bench/effects/*.c)
HEADERS  := $(wildcard include/*.h libmsr/*/*.h libmsr/*/*.inc cli/*.h tests/*.h tests/fuzz/*.h \
            tests/stability/*.h tests/bench/*.h tests/bench/stability/*.h tests/bench/speed/*.h)
DOCS     := $(wildcard README.md LICENSE CHANGELOG.md docs/*.md docs/images/*.png include/*.h \
             examples/*.md examples/*.c examples/scenes/*)
MAN      := $(wildcard docs/*.1)

object    = $(addprefix $(BUILD)/obj/,$(addsuffix .o,$(basename $(1))))
LIB_OBJ   = $(call object,$(LIB_SRC))
SHARED    = $(BUILD)/libmsr.so.$(VERSION)
LIBS      = libmsr.a $(notdir $(SHARED)) libmsr.so.$(MAJOR) libmsr.so
PRODUCTS  = $(BUILD)/msr $(addprefix $(BUILD)/,$(LIBS))
TESTS     = $(TEST_SRC:%.c=$(BUILD)/%)
EXAMPLES  = $(EX_SRC:%.c=$(BUILD)/%)
FUZZERS   = $(FUZZ_SRC:tests/fuzz/%.c=$(BUILD)/%)

comma := ,
MAKEFLAGS += --no-print-directory
# `make deps test` installs before it builds, with -j too.
FIRST := $(filter deps,$(MAKECMDGOALS))
# $(call show,WORD): in the place of the command, its name and target.
show = $(if $(V),,@printf '  %-5s %s\n' $(1) $@;)

# ---- Building ------------------------------------------------------------------------------------

## all: the command, the static and the shared library, all in build/ (default)
all: $(PRODUCTS)

# A file that changes only when what it says does, so that what depends on it is made again.
$(BUILD)/flags: says = $(COMPILE) $(LDFLAGS) $(GSL_CFLAGS) $(GSL_LIBS)
$(BUILD)/sources: says = $(LIB_SRC) $(CLI_SRC)
$(BUILD)/flags $(BUILD)/sources: FORCE | $(FIRST)
	@test -n '$(GSL_LIBS)' || { echo 'GSL is missing: run `make deps`' >&2; exit 1; }
	@mkdir -p $(@D); echo '$(says)' | cmp -s - $@ || echo '$(says)' > $@

$(BUILD)/obj/libmsr/%.o $(BUILD)/obj/tests/%.o: INTERNAL = -Ilibmsr $(GSL_CFLAGS)
$(BUILD)/obj/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call show,CC)$(COMPILE) $(INTERNAL) $(OWN) -MMD -MP -c $< -o $@

# gcc vectorises floor() and comparisons of numbers only if they can't trap.
$(call object,libmsr/contacts/flock.c libmsr/run/canvas.c): ARITHMETIC += -fno-trapping-math

$(BUILD)/libmsr.a: $(LIB_OBJ) $(BUILD)/sources
	@rm -f $@
	$(call show,AR)$(AR) rcs $@ $(LIB_OBJ)

$(SHARED): $(LIB_OBJ) $(BUILD)/sources
	$(call show,LINK)$(LINK) -shared -Wl,-soname,libmsr.so.$(MAJOR) -o $@ $(LIB_OBJ) $(GSL_LIBS)

$(BUILD)/libmsr.so.$(MAJOR) $(BUILD)/libmsr.so: $(SHARED)
	@ln -sf $(<F) $@

$(BUILD)/msr: $(call object,$(CLI_SRC)) $(BUILD)/libmsr.a $(BUILD)/sources
	$(call show,LINK)$(LINK) -o $@ $(filter %.o %.a,$^) $(GSL_LIBS)

## examples: the programs of examples/, in build/examples/
examples: $(EXAMPLES)

$(EXAMPLES): $(BUILD)/examples/%: $(BUILD)/obj/examples/%.o $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(LINK) -o $@ $^ $(GSL_LIBS)

# ---- Running -------------------------------------------------------------------------------------

## deps: installs what is missing; with other goals, only what they need (make deps demo)
deps:
	@CC='$(CC)' PKG_CONFIG='$(PKG_CONFIG)' BUILD='$(BUILD)' sh tests/mk-deps.sh $(filter-out deps,$(MAKECMDGOALS))

## demo: frames of a real scene in build/demo/
SCENE = examples/scenes/assignment
demo: all
	$(BUILD)/msr $(SCENE).ppm $(SCENE).conf -o $(BUILD)/demo --force
	@echo 'The frames are $(BUILD)/demo/frame-000000.ppm and on. To look at them, enlarged:'
	@echo '  ffplay -framerate 25 -vf scale=iw*4:-1:flags=neighbor $(BUILD)/demo/frame-%06d.ppm'
	@echo 'or as a film:'
	@echo '  ffmpeg -framerate 25 -i $(BUILD)/demo/frame-%06d.ppm' \
	      '-vf scale=iw*4:ih*4:flags=neighbor -pix_fmt yuv420p $(BUILD)/demo.mp4'

# ---- Testing -------------------------------------------------------------------------------------

# A test's opening comment may hold `link: --wrap=malloc ...`: options of the linker for it alone.
wraps = $(filter --%,$(shell grep -m1 'link: --' tests/$*.c))
$(TESTS): $(BUILD)/tests/%: $(BUILD)/obj/tests/%.o $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(LINK) -o $@ $(filter %.o,$^) $(BUILD)/libmsr.a \
	  $(addprefix -Wl$(comma),$(wraps)) -lcmocka $(GSL_LIBS)

# test_hard runs the cases of tests/stability.
$(BUILD)/tests/test_hard: $(call object,$(HARD_SRC))

# test_corpus runs every fuzzer on its corpus: there the entry of fuzz_x.c is called fuzz_x.
$(BUILD)/tests/test_corpus: $(call object,$(FUZZ_SRC))
rename = -DLLVMFuzzerTestOneInput=$(*F)
$(BUILD)/obj/tests/fuzz/%.o: OWN = $(if $(findstring fuzzer,$(SAN)),,$(rename))

LOCALE = $(BUILD)/locale/fr_FR.UTF-8
$(LOCALE): | $(FIRST)
	@mkdir -p $(@D)
	@localedef -i fr_FR -f UTF-8 $@ 2>/dev/null || \
	  echo 'No French locale can be made: the tests of it are skipped.'

RUN_TESTS = BUILD='$(abspath $(BUILD))' CC='$(CC)' PKG_CONFIG='$(PKG_CONFIG)' \
            WARNINGS='$(WARNINGS)' C_WARNINGS='$(C_WARNINGS)' sh tests/run.sh
# Scripts that look at the tree: sanitizers would only be in their way.
CHECKS    = $(if $(SAN),,$(wildcard tests/check_*.sh))

everything: all examples $(TESTS) $(LOCALE)

## test: builds everything and runs every test; ends in `N passed, N failed`
test: everything
	@$(RUN_TESTS) $(TESTS) $(wildcard tests/cli/run.sh) $(CHECKS)

## check: both compilers, sanitizers, valgrind, clang-tidy, cppcheck, clang-format
check: check-gcc check-clang check-san check-valgrind check-tidy check-cppcheck check-format
	@echo 'check: all is well'

check-gcc: | $(FIRST)
	$(MAKE) BUILD=build/gcc CC=gcc CFLAGS='$(CFLAGS) -Werror' everything

check-clang: | $(FIRST)
	$(MAKE) BUILD=build/clang CC=clang CFLAGS='$(CFLAGS) -Werror' test

check-san: | $(FIRST)
	$(MAKE) SAN=address,undefined test

# Programs that take seconds without valgrind would take minutes with it: run.sh leaves them out.
check-valgrind: $(TESTS) $(LOCALE)
	@RUNNER='valgrind -q --leak-check=full --error-exitcode=99' $(RUN_TESTS) $(TESTS)

# $(call tidy,FILES,CHECKS); what it finds is on stdout, how much it left out on stderr.
tidy = printf '%s\n' $(1) | xargs -P 2 -I {} sh -c \
       "clang-tidy --quiet --checks='$(2)' {} -- $(LANGUAGE) -Ilibmsr $(GSL_CFLAGS) 2>/dev/null"
check-tidy: | $(FIRST)
	$(call tidy,$(LIB_SRC))
	$(call tidy,$(CLI_SRC) $(EX_SRC),-concurrency-mt-unsafe)

check-cppcheck: | $(FIRST)
	cppcheck -q --std=c11 --enable=warning,performance,portability --inline-suppr \
	  --error-exitcode=1 -Iinclude -Ilibmsr libmsr cli examples

check-format: | $(FIRST)
	clang-format --dry-run -Werror $(SOURCES) $(HEADERS)

## format: formats every source with clang-format
format: | $(FIRST)
	clang-format -i $(SOURCES) $(HEADERS)

## coverage: lines of libmsr/ that the tests reach; at least 95 %
coverage: | $(FIRST)
	@find build/coverage -name '*.gcda' -delete 2>/dev/null || true
	COVERAGE=1 $(MAKE) BUILD=build/coverage CC=gcc \
	  CFLAGS='-O0 -g --coverage -fprofile-update=atomic' CHECKS= test
	gcovr --root . --filter libmsr/ --fail-under-line 95 build/coverage

## fuzz SECONDS=60: each fuzzer for so long, on a copy of its corpus
SECONDS = 60
fuzz: | $(FIRST)
	$(MAKE) BUILD=build/fuzz CC=clang SAN=fuzzer-no-link,address,undefined run-fuzzers

$(FUZZERS): $(BUILD)/%: $(BUILD)/obj/tests/fuzz/%.o $(BUILD)/libmsr.a
	$(call show,LINK)$(LINK) -fsanitize=fuzzer -o $@ $^ $(GSL_LIBS)

run-fuzzers: $(FUZZERS)
	@mkdir -p $(BUILD)/corpus
	@for fuzzer in $(FUZZERS:$(BUILD)/fuzz_%=%); do \
	  cp -r tests/fuzz/corpus/$$fuzzer $(BUILD)/corpus && \
	  $(BUILD)/fuzz_$$fuzzer -max_total_time=$(SECONDS) -timeout=10 -print_final_stats=1 \
	    -artifact_prefix=$(BUILD)/$$fuzzer- $(BUILD)/corpus/$$fuzzer || exit; \
	done

# ---- Stability -----------------------------------------------------------------------------------

## stability CASES=limit: hard cases, as a table; all of them (the default) take a while
CASES =
stability: $(BUILD)/tests/test_hard
	@$< long '$(CASES)'

## mutations: takes each protection out of a copy of the library and sees which hard case fails
mutations: all
	@BUILD='$(abspath $(BUILD))' sh tests/stability/mutations.sh

# ---- Benchmarks ----------------------------------------------------------------------------------

# One object is the right-hand side that Python loads, with those of the problem.
BENCH     = $(BUILD)/bench/accuracy
BENCH_RHS = $(BUILD)/bench/scipy_rhs.so
BENCH_OBJ = $(filter-out %/scipy_rhs.o,$(call object,$(BENCH_SRC)))
RHS_OBJ   = $(call object,tests/bench/scipy_rhs.c tests/bench/problem.c tests/bench/fail.c)
SUNDIALS_LIBS = -lsundials_arkode -lsundials_cvode -lsundials_nvecserial -lsundials_generic

$(BUILD)/obj/%.o: %.cc $(BUILD)/flags
	@mkdir -p $(@D)
	$(call show,CXX)$(CXX) -std=c++17 -Iinclude $(WARNINGS) $(CFLAGS) $(ARITHMETIC) \
	  -MMD -MP -c $< -o $@

$(BENCH): $(BENCH_OBJ) $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(CXX) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(SUNDIALS_LIBS) $(GSL_LIBS)

$(BENCH_RHS): $(RHS_OBJ) $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(LINK) -shared -o $@ $^ $(GSL_LIBS)

## bench-accuracy: accuracy against time, beside other libraries; some minutes
bench-accuracy: $(BENCH) $(BENCH_RHS)
	@$(BENCH) tests/bench/scipy_peer.py $(BENCH_RHS)

## bench-guard: the guard's share of the instructions of runs, by valgrind; a minute
bench-guard: $(BUILD)/msr
	@sh tests/bench/guard.sh $<

## bench-effects: what is off costs nothing: instructions, by valgrind; some minutes
bench-effects: $(BUILD)/msr
	@BUILD='$(BUILD)' CC='$(CC)' PKG_CONFIG='$(PKG_CONFIG)' sh tests/bench/effects/run.sh

BESIDE = $(BUILD)/bench/stability

$(BESIDE): $(call object,$(BESIDE_SRC) tests/bench/fail.c tests/bench/machine.c) $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(CXX) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lchipmunk -lbox2d $(GSL_LIBS)

## bench-stability: hard cases, beside other libraries; some minutes
bench-stability: $(BESIDE)
	@$(BESIDE)

SPEED = $(BUILD)/bench/speed

# The assignment's program is compiled as a student does; the kernel's vectors are arguments of
# inlined functions only.
$(BUILD)/obj/tests/bench/speed/assignment.o: OWN = -O2 -fmath-errno
$(BUILD)/obj/tests/bench/speed/limit_kernel.o: OWN = -Wno-psabi

$(SPEED): $(call object,$(SPEED_SRC) tests/bench/fail.c tests/bench/machine.c) $(BUILD)/libmsr.a
	@mkdir -p $(@D)
	$(call show,LINK)$(LINK) -pthread -o $@ $^ $(GSL_LIBS)

## bench TABLES=blocks: speed, beside others and the machine's limit; all (the default) take minutes
TABLES =
bench: $(SPEED)
	@mkdir -p $(BUILD)/bench/peers
	@$(SPEED) $(BUILD)/bench/peers $(TABLES)

# ---- Report --------------------------------------------------------------------------------------

STUDIES = turn assignment pendulum
CSV     = $(STUDIES:%=docs/report/%.csv) docs/report/impacts.csv
REPORT  = $(BUILD)/report

## report: docs/report as build/report/report.pdf, from the CSVs there
report: $(REPORT)/report.pdf

# Twice, for the references; TEXINPUTS is where it finds figures and numbers.
$(REPORT)/report.pdf: docs/report/report.tex $(REPORT)/numbers.tex $(STUDIES:%=$(REPORT)/%.pdf)
	$(if $(V),,@printf '  %-5s %s\n' TEX $@;) for pass in 1 2; do \
	  TEXINPUTS=$(REPORT): pdflatex -interaction=nonstopmode -halt-on-error \
	    -output-directory=$(REPORT) $< > $(REPORT)/log || { tail -n 20 $(REPORT)/log >&2; exit 1; }; \
	done
	@! grep -A 2 -E 'undefined|Overfull' $(REPORT)/report.log >&2
	@pages=$$(pdfinfo $@ | sed -n 's/^Pages: *//p'); \
	[ $$pages -ge 5 ] && [ $$pages -le 10 ] || { echo "$@: $$pages pages, not 5 to 10" >&2; exit 1; }

$(REPORT)/numbers.tex: docs/report/numbers.awk $(CSV) | $(FIRST)
	@mkdir -p $(@D)
	$(call show,AWK)awk -f $< $(CSV) > $@

$(REPORT)/%.pdf: docs/report/%.csv docs/report/figure.gp | $(FIRST)
	@mkdir -p $(@D)
	$(call show,PLOT)gnuplot -c docs/report/figure.gp $< $@

# A study is told what the scene's conf says.
study = $(BUILD)/msr accuracy examples/scenes/$(1).ppm examples/scenes/$(1).conf \
        $$(sed -n 's/^. msr [^ ]* [^ ]*//p' examples/scenes/$(1).conf) $(2) \
        --csv docs/report/$(1).csv --plot $(REPORT)/$(1).svg

## figures: the report's studies anew, a quarter of an hour: docs/report/*.csv, build/report/*.svg
figures: all
	@mkdir -p $(REPORT)
	$(call study,turn,--budget 120)
	$(call study,assignment,--until 2 --budget 300)
	$(call study,pendulum,--until 1 --budget 400)
	sh docs/report/impacts.sh $(BUILD)/msr > docs/report/impacts.csv

# ---- Installing ----------------------------------------------------------------------------------

## install: to PREFIX=/usr/local, under DESTDIR if given
install: all
	install -D -m 755 -t $(DESTDIR)$(PREFIX)/bin $(BUILD)/msr
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/include include/msr.h
	install -D -m 644 -t $(DESTDIR)$(LIBDIR) $(BUILD)/libmsr.a
	install -D -m 755 -t $(DESTDIR)$(LIBDIR) $(SHARED)
	ln -sf $(notdir $(SHARED)) $(DESTDIR)$(LIBDIR)/libmsr.so.$(MAJOR)
	ln -sf $(notdir $(SHARED)) $(DESTDIR)$(LIBDIR)/libmsr.so
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(patsubst $(PREFIX)/%,$${prefix}/%,$(LIBDIR))|' \
	  -e 's|@VERSION@|$(VERSION)|' libmsr/msr.pc.in > $(DESTDIR)$(LIBDIR)/pkgconfig/msr.pc
	for f in $(DOCS); do install -D -m 644 $$f $(DESTDIR)$(DOCDIR)/$$f || exit; done
	for f in $(MAN); do install -D -m 644 -t $(DESTDIR)$(MANDIR) $$f || exit; done

## uninstall: removes what install installs
uninstall:
	rm -f $(addprefix $(DESTDIR)$(PREFIX)/,bin/msr include/msr.h) \
	  $(addprefix $(DESTDIR)$(LIBDIR)/,$(LIBS) pkgconfig/msr.pc) \
	  $(addprefix $(DESTDIR)$(DOCDIR)/,$(DOCS)) $(addprefix $(DESTDIR)$(MANDIR)/,$(notdir $(MAN)))
	rmdir $(addprefix $(DESTDIR)$(DOCDIR)/,examples/scenes examples docs/images docs include) \
	  $(DESTDIR)$(DOCDIR) 2>/dev/null || true

## clean: removes build/, where all is
clean:
	rm -rf build

## help: this list
help:
	@sed -n 's/^## \([^:]*\): /  make \1\t/p' Makefile | expand -t 36

.PHONY: all examples everything deps demo test check check-gcc check-clang check-san \
        check-valgrind check-tidy check-cppcheck check-format format coverage fuzz run-fuzzers \
        stability mutations bench bench-accuracy bench-guard bench-effects bench-stability report figures \
        install uninstall clean help
FORCE:
.DELETE_ON_ERROR:
-include $(patsubst %.o,%.d,$(call object,$(SOURCES)))
