#!/bin/sh
# check_floors.sh - a file of libmsr/ includes headers of its own floor or lower, no header includes
# itself through others, and cli/ sees include/msr.h and its own headers only.
set -eu
cd "${1:-$(dirname "$0")/..}"

# Prints `file header` for every #include "..." of libmsr/ and cli/; looks where the compiler looks.
includes() {
  grep -Hoe '^ *# *include *"[^"]*"' libmsr/*/*.[ch] libmsr/*/*.inc cli/*.[ch] | tr -d '"' |
    while IFS=': ' read -r file _ header; do
      case $file in cli/*) roots=include ;; *) roots='include libmsr' ;; esac
      found="missing:$header"
      for path in $roots "${file%/*}"; do
        [ ! -f "$path/$header" ] || found=$path/$header
      done
      echo "$file $found"
    done
}

pairs=$(includes)

echo "$pairs" | awk '
  BEGIN {
    split("base:0 formats:1 forces:1 integrators:1 contacts:1 solvers:1 scene:2 plan:3 sweep:3 run:4 accuracy:4", floors, " ")
    for (i in floors) { split(floors[i], f, ":"); floor["libmsr/" f[1]] = f[2] }
    floor["include"] = -1
    floor["cli"] = 5
  }
  function place(path) { sub("/[^/]*$", "", path); return path }
  function wrong(why) { print $1 ": " why; bad = 1 }
  {
    from = place($1); to = place($2)
    if (sub("^missing:", "", $2)) { wrong("no such header: " $2); next }
    if (!(from in floor)) { wrong("not on any floor"); next }
    if (!(to in floor)) { wrong($2 " is not on any floor"); next }
    if (floor[to] > floor[from]) wrong($2 " is " floor[to] - floor[from] " floors above")
    if (from == "cli" && to ~ "^libmsr") wrong($2 " is internal to the library")
  }
  END { exit bad }'

# tsort names the files of a cycle and fails.
echo "$pairs" | tsort >/dev/null

if grep -n '# *include *<gsl' cli/*.[ch]; then
  echo 'cli/ reaches GSL through the library only'
  exit 1
fi
