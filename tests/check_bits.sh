#!/bin/sh
# check_bits.sh - a state has the same bits whatever compiled the library: each compiler that is
# there, without optimisation and with all of it, for any machine and for this one, with wide vectors
# and without; and for any number of threads.
#
# Environment: PKG_CONFIG.
set -eu
cd "$(dirname "$0")/.."
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
gsl_cflags=$(${PKG_CONFIG:-pkg-config} --cflags gsl)
gsl_libs=$(${PKG_CONFIG:-pkg-config} --libs gsl)
scene=examples/scenes/heap
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)

build() { # program compiler options...
  mkdir "$1.o"
  program=$1
  shift
  printf '%s\n' tests/bits/bits.c libmsr/*/*.c | xargs -P "$jobs" -I '{}' sh -c '
    source=$1 objects=$2
    shift 2
    exec "$@" -c "$source" -o "$objects/$(echo "$source" | tr / _).o"' \
    - '{}' "$program.o" "$@" -std=c11 -pthread -D_POSIX_C_SOURCE=200809L -ffp-contract=off \
    -fno-math-errno -Iinclude -Ilibmsr $gsl_cflags
  "$1" -pthread -Wl,--wrap=msri_processors "$program.o"/*.o $gsl_libs -lm -o "$program"
}

compare() { # compiler options...
  command -v $1 >/dev/null || return 0
  n=$((n + 1))
  build "$tmp/$n" "$@"
  { "$tmp/$n" $scene.ppm $scene.conf || echo "no hashes"; } | sed "s/^/$*: /" >"$tmp/$n.hashes" &
}

n=0
compare gcc -O0
compare clang -O0 -DMSRI_NARROW
compare clang -O3 -march=native
compare gcc -O3 -march=native
wait
cat "$tmp"/*.hashes | tee "$tmp/all"
if grep -q 'no hashes' "$tmp/all"; then exit 1; fi
[ "$(sed "s/.*: //" "$tmp/all" | sort -u | wc -l)" = "$(sed "s/.*: //; s/ .*//" "$tmp/all" | sort -u | wc -l)" ]
