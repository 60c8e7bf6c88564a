#!/bin/sh
# check_header.sh - every header compiles alone, with no warning: msr.h as C11 and as C++17, those
# of the library and of the command as C11, with each compiler that is there.
#
# Environment: WARNINGS, C_WARNINGS (options for both languages, for C only), PKG_CONFIG.
set -eu
cd "$(dirname "$0")/.."
gsl=$(${PKG_CONFIG:-pkg-config} --cflags gsl)
tried=0

compile() { # compiler header options...
  compiler=$1 header=$2
  shift 2
  command -v "$compiler" >/dev/null || return 0
  echo "$compiler $header"
  printf '#include "%s"\nextern int nothing;\n' "$header" |
    "$compiler" "$@" ${WARNINGS:--Wall -Wextra} -Werror -Iinclude -fsyntax-only -
  tried=$((tried + 1))
}

for compiler in gcc clang; do
  for header in include/*.h libmsr/*/*.h cli/*.h; do
    [ ! -e "$header" ] || compile $compiler "$PWD/$header" -xc -std=c11 \
      -D_POSIX_C_SOURCE=200809L ${C_WARNINGS:-} -Ilibmsr $gsl
  done
done
for compiler in g++ clang++; do
  compile $compiler msr.h -xc++ -std=c++17
done
[ $tried -gt 0 ]
