#!/bin/sh
# check_bits.sh - a state has the same bits whatever compiled the library: each compiler that is
# there, without optimisation and with all of it, for any machine and for this one.
#
# Environment: PKG_CONFIG.
set -eu
cd "$(dirname "$0")/.."
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
gsl=$(${PKG_CONFIG:-pkg-config} --cflags --libs gsl)

hash_with() { # compiler options...
  "$@" -std=c11 -D_POSIX_C_SOURCE=200809L -ffp-contract=off -fno-math-errno -Iinclude -Ilibmsr \
    tests/bits/bits.c libmsr/*/*.c $gsl -lm -o "$tmp/bits"
  "$tmp/bits" examples/scenes/letters.ppm examples/scenes/letters.conf
}

for compiler in gcc clang; do
  command -v $compiler >/dev/null || continue
  for options in -O0 '-O3 -march=native'; do
    hash_with $compiler $options | sed "s/^/$compiler $options: /" | tee -a "$tmp/all"
  done
done
[ "$(sed "s/.*: //" "$tmp/all" | sort -u | wc -l)" = "$(sed "s/.*: //; s/ .*//" "$tmp/all" | sort -u | wc -l)" ]
