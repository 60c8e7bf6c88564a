#!/bin/sh
# impacts.sh MSR - the total energy of the scene `assignment` over its 100 s, by both rules of impact
# at four steps: its least and largest change, over that at the start (heights count from the
# picture's lower edge). A CSV on standard output.
set -eu
msr=$1 scene=examples/scenes/assignment
stats=$(mktemp)
trap 'rm -f "$stats"' EXIT

echo "# command: $msr $scene.ppm $scene.conf --no-frames --stats FILE --impacts RULE --substeps N"
echo "# date: $(date -u +%Y-%m-%d)"
echo "impacts,substeps,until,least,most"
for rule in kept located; do
  for n in 1 2 4 8; do
    status=0
    "$msr" $scene.ppm $scene.conf --no-frames --stats "$stats" --impacts $rule \
      --substeps $n -q || status=$?
    [ $status -eq 0 ] || [ $status -eq 4 ]
    awk -F, -v row="$rule,$n" '
      FNR == 2 { start = $6 }
      FNR > 1 { change = $6 / start - 1 }
      change < least { least = change }
      change > most { most = change }
      END { printf "%s,%.4g,%.3g,%.3g\n", row, $2, least, most }' "$stats"
  done
done
