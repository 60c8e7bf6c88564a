#!/bin/sh
# mutations.sh - takes one protection at a time out of a copy of the library, runs the short form of
# the stability suite on it, and says which cases fail: the one that is named must be among them.
#
# A mutation is two lines:
#   what is bounded | the case that must fail | files to compile anew
#   FILE sed-script
# Environment: BUILD.
set -u
cd "$(dirname "$0")/../.."
build=${BUILD:-$PWD/build}
cc=${CC:-cc}
gsl=$(${PKG_CONFIG:-pkg-config} --cflags --libs gsl)
caught=0 missed=0

# Compiles `sources` of the copy in $1, and links them in the place of those of the library.
compile() { # directory, sources...
  dir=$1
  shift
  objects=
  for source in "$@"; do
    object=$dir/$(echo "$source" | tr / -).o
    $cc -std=c11 -D_POSIX_C_SOURCE=200809L -O2 -w -ffp-contract=off -fno-math-errno -Iinclude \
      -I"$dir/libmsr" $gsl -c "$dir/libmsr/$source.c" -o "$object" || return 1
    objects="$objects $object"
  done
  $cc -o "$dir/test_hard" "$build"/obj/tests/test_hard.o "$build"/obj/tests/stability/*.o $objects \
    "$build/libmsr.a" -lcmocka $gsl -lm
}

run() { # bound, case, sources, file, script
  number=$((caught + missed + 1))
  dir=$build/mutants/$number
  rm -rf "$dir"
  mkdir -p "$dir"
  cp -r libmsr "$dir"
  sed -i "$5" "$dir/libmsr/$4"
  verdict=
  cmp -s "libmsr/$4" "$dir/libmsr/$4" && verdict='NOT APPLIED: the script changes nothing'
  [ -n "$verdict" ] || compile "$dir" $3 || verdict='NOT COMPILED'
  failing=
  if [ -z "$verdict" ]; then
    timeout 300 "$dir/test_hard" short >"$dir/table" 2>&1
    # a case that crashes has no row, and all after it have none
    failing=$(awk '/ FAILED: / { n++ } END { print n + 0 }' "$dir/table")
    if grep -q "^$2 .* FAILED: " "$dir/table"; then
      verdict=caught
    else
      verdict='NOT CAUGHT'
    fi
  fi
  [ "$verdict" = caught ] && caught=$((caught + 1)) || missed=$((missed + 1))
  printf '%-46s %-40s %3s  %s\n' "$1" "$2" "${failing:--}" "$verdict"
}

printf '%-46s %-40s %3s  %s\n' 'PROTECTION THAT IS TAKEN OUT' 'case that must fail' all verdict
while IFS='|' read -r bound case sources; do
  IFS=' ' read -r file script
  run "$bound" "$case" "$sources" "$file" "$script" </dev/null
done <tests/stability/mutations.txt
echo "$caught passed, $missed failed"
[ $missed -eq 0 ] && [ $caught -gt 0 ]
