#!/bin/sh
# mk-deps.sh - installs what the goals of `make deps GOALS` need and isn't there; if no goal is given
# all but the benchmark's peers and LaTeX for the report. It needs neither network nor root when
# nothing is missing. Debian and Ubuntu only; on other systems it says what to install.
set -eu
cc=${CC:-cc}

has() { command -v "$1"; }
header() { printf '#include <%s>\n' "$@" | $cc -E -; }
scipy() { python3 -c 'import scipy' || /usr/bin/python3 -c 'import scipy'; }
numpy() { python3 -c 'import numpy' || /usr/bin/python3 -c 'import numpy'; }
header_cxx() { printf "#include <%s>\n" "$@" | g++ -E -x c++ -; }
fuzzer() { echo 'int LLVMFuzzerTestOneInput(void) { return 0; }' |
  clang -fsanitize=fuzzer,address -xc - -o /dev/null; }

# What needs it | how to see that it's there | Debian and Ubuntu | Fedora | Arch | Homebrew
table='
build    | header stdio.h                      | gcc libc6-dev   | gcc                   | gcc          | gcc
build    | has pkg-config                      | pkg-config      | pkgconf               | pkgconf      | pkgconf
build    | ${PKG_CONFIG:-pkg-config} --exists gsl | libgsl-dev   | gsl-devel             | gsl          | gsl
test     | header stdarg.h stddef.h setjmp.h stdint.h cmocka.h | libcmocka-dev | libcmocka-devel | cmocka | cmocka
test     | has g++                             | g++             | gcc-c++               | gcc          | gcc
test     | has clang                           | clang           | clang                 | clang        | llvm
test     | has valgrind                        | valgrind        | valgrind              | valgrind     | valgrind
test     | has pnmtopng                        | netpbm          | netpbm-progs          | netpbm       | netpbm
test     | has ffmpeg                          | ffmpeg          | ffmpeg-free           | ffmpeg       | ffmpeg
test     | has gnuplot                     | gnuplot-nox     | gnuplot               | gnuplot      | gnuplot
test     | has python3                         | python3         | python3               | python       | python
test     | numpy                               | python3-numpy   | python3-numpy         | python-numpy | numpy
test     | has groff                           | groff-base      | groff-base            | groff        | groff
test     | test -e /usr/share/i18n/locales/fr_FR | locales       | glibc-locale-source   | glibc        | glibc
check    | has clang-tidy                      | clang-tidy      | clang-tools-extra     | clang        | llvm
check    | has clang-format                    | clang-format    | clang-tools-extra     | clang        | clang-format
check    | has cppcheck                        | cppcheck        | cppcheck              | cppcheck     | cppcheck
coverage | has gcovr                           | gcovr           | gcovr                 | gcovr        | gcovr
bench    | has g++                             | g++             | gcc-c++               | gcc          | gcc
bench    | header cvode/cvode.h                | libsundials-dev | sundials-devel        | sundials     | sundials
bench    | header boost/version.hpp            | libboost-dev    | boost-devel           | boost        | boost
bench    | scipy                               | python3-scipy   | python3-scipy         | python-scipy | scipy
beside   | has g++                             | g++             | gcc-c++               | gcc          | gcc
beside   | header chipmunk/chipmunk.h          | libchipmunk-dev | chipmunk-devel        | chipmunk     | chipmunk
beside   | header_cxx box2d/box2d.h             | libbox2d-dev    | Box2D-devel           | box2d        | box2d
speed    | has lmp                             | lammps          | lammps                | lammps       | lammps
speed    | has mpirun                          | openmpi-bin     | openmpi               | openmpi      | open-mpi
speed    | has stdbuf                          | coreutils       | coreutils             | coreutils    | coreutils
speed    | python3 -m ensurepip --version      | python3-venv    | python3               | python       | python
fuzz     | fuzzer                              | libclang-rt-dev | compiler-rt           | compiler-rt  | llvm
report   | has gnuplot                         | gnuplot-nox     | gnuplot               | gnuplot      | gnuplot
report   | kpsewhich booktabs.sty lmodern.sty  | texlive-latex-recommended lmodern | texlive-collection-latexrecommended texlive-lm | texlive-latexrecommended texlive-fontsrecommended | texlive
report   | has pdfinfo                         | poppler-utils   | poppler-utils         | poppler      | poppler
'

groups=build
for goal in "${@:-everything}"; do
  case $goal in
  all | demo | examples | install | uninstall | clean | help) ;;
  test | bench-guard | bench-effects) groups="$groups test" ;;
  bench) groups="$groups speed" ;;
  bench-accuracy) groups="$groups bench" ;;
  bench-stability) groups="$groups beside" ;;
  check | coverage | fuzz) groups="$groups test $goal" ;;
  report | figures) groups="$groups report" ;;
  *) groups='build test check coverage fuzz' ;;
  esac
done

# Debian's Numba is years old and several times slower: the benchmark's is PyPI's, in build/.
pypi() {
  case " $groups " in
  *' speed '*) ;;
  *) return 0 ;;
  esac
  python=${BUILD:-build}/bench/peers/python
  "$python/bin/python3" -c 'import numba' 2>/dev/null && return
  echo 'deps: installing Numba from PyPI'
  python3 -m venv "$python" && "$python/bin/python3" -m pip install -q numba ||
    echo "deps: it can't be had; the benchmark does without, or with your Python's"
}

missing=$(echo "$table" | while IFS='|' read -r group check names; do
  case " $groups " in
  *" ${group%% *} "*) eval "$check" >/dev/null 2>&1 </dev/null || echo "$names" ;;
  esac
done)
column() { echo "$missing" | cut -d'|' -f"$1" | tr -s ' ' '\n' | sort -u | xargs; }

if [ -z "$missing" ]; then
  pypi
  echo 'deps: nothing is missing'
  exit
fi
if ! command -v apt-get >/dev/null; then
  echo 'Please install:'
  printf '  %-10s%s\n' Fedora "$(column 2)" Arch "$(column 3)" Homebrew "$(column 4)"
  exit 1
fi

sudo=
if [ "$(id -u)" -ne 0 ]; then
  sudo=sudo
  command -v sudo >/dev/null || { echo "As root: apt-get install $(column 1)"; exit 1; }
fi
echo "deps: installing $(column 1)"
$sudo apt-get update -qq
known=$(for name in $(column 1); do
  ! apt-cache show "$name" >/dev/null 2>&1 || echo "$name"
done)
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $known
pypi
