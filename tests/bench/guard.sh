#!/bin/sh
# guard.sh - what the guard costs: its share of all instructions of a run, counted by callgrind.
#   sh tests/bench/guard.sh build/msr
set -eu
msr=$(realpath "${1:-build/msr}")
scenes=$(realpath "$(dirname "$0")/../../examples/scenes")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# block N FLOOR ITERATIONS: N x N masses above a floor, or above nothing.
block() {
  awk -v n="$1" -v floor="$2" 'BEGIN {
    print "P3\n" n + 10, n + 20, "\n255"
    for (y = 0; y < n + 20; y++) for (x = 0; x < n + 10; x++)
      print (floor && y == n + 19 ? "0 0 0" : \
             x >= 5 && x < n + 5 && y >= 5 && y < n + 5 ? "255 0 0" : "255 255 255") }' > scene.ppm
  conf "$3" 1
}

# conf ITERATIONS IMAGES
conf() {
  printf 'DT\n0.005\nGRAVITE\n9.8\nMASSE\n0.1\nTENSION_RESSORT\n1500\n' > scene.conf
  printf 'NB_ITERATIONS\n%s\nNB_IMAGES\n%s\n' "$1" "$2" >> scene.conf
}

# share NAME [OPTION ...]: looks at all energies, glances at speeds, the work of driving forces.
share() {
  name=$1
  shift
  valgrind -q --tool=callgrind --callgrind-out-file=out "$msr" scene.ppm scene.conf -q \
    --no-frames "$@"
  callgrind_annotate --inclusive=yes --threshold=100 out 2> /dev/null | tr -d ',' |
    awk -v name="$name" '
      /PROGRAM TOTALS/ { total = $1 }
      !/=>/ && /:(msr_state_check|msri_sum_squares|msri_guard_follow|msri_care_watch) / { guard += $1 }
      END { printf "%-28s %5.2f %%\n", name, 100 * guard / total }'
}

block 20 1 4000;  share '20 x 20, floor'
                  share '20 x 20, floor, wind' --wind 5
block 20 0 4000;  share '20 x 20, free'
block 100 1 1000; share '100 x 100, floor'
                  share '100 x 100, floor, wind' --wind 5
block 100 0 1000; share '100 x 100, free'
cp "$scenes/assignment.ppm" scene.ppm
conf 1000 40;     share 'assignment, 40 frames'
                  share 'assignment, wind, 40 frames' --wind 5
