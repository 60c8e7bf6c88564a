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
gsl=$(${PKG_CONFIG:-pkg-config} --cflags --libs gsl)

hash_with() { # compiler options...
  "$@" -std=c11 -pthread -D_POSIX_C_SOURCE=200809L -ffp-contract=off -fno-math-errno -Iinclude -Ilibmsr \
    tests/bits/bits.c libmsr/*/*.c $gsl -lm -o "$tmp/bits"
  "$tmp/bits" examples/scenes/letters.ppm examples/scenes/letters.conf > "$tmp/hashes"
}

compare() { # compiler options...
  command -v $1 >/dev/null || return 0
  hash_with "$@"
  sed "s/^/$*: /" "$tmp/hashes" | tee -a "$tmp/all"
}

compare gcc -O0
compare gcc -O3 -march=native
compare clang -O0 -DMSRI_NARROW
compare clang -O3 -march=native
[ "$(sed "s/.*: //" "$tmp/all" | sort -u | wc -l)" = "$(sed "s/.*: //; s/ .*//" "$tmp/all" | sort -u | wc -l)" ]
