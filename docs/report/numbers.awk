# numbers.awk - the CSVs of this directory as LaTeX. For each NAME.csv that `msr accuracy` wrote the
# commands \NAMEmachine, \NAMEdate and so on; \cheapest, the rows of the table of cheapest methods;
# \impacts, those of the table of energies that impacts.sh wrote to impacts.csv.
function tex(text) {
  gsub(/_/, "\\_", text)
  gsub(/--/, "-{}-", text)
  return text
}

function power(value,  parts) {
  value += 0
  if (value >= 0.01 && value < 1000) return sprintf("$%.3g$", value)
  split(sprintf("%.1e", value), parts, "e")
  return "$" parts[1] "\\cdot10^{" parts[2] + 0 "}$"
}

function three(value) { return sprintf(value < 100 ? "%.3g" : "%.0f", value) }

# "0" for what is rounding.
function percent(value) {
  value *= 100
  return value * value < 1e-16 ? "0" : sprintf(value < 10 ? "$%+.2g\\,\\%%$" : "$%+.0f\\,\\%%$", value)
}

function define(name, text) { printf "\\newcommand{\\%s%s}{%s}\n", scene, name, text }

# The fastest of those that are as accurate as asked, the reference's own error included.
function consider(i) {
  if ($9 + own > 10 ^ -exponent[i] || ((i, scene) in least && $7 >= least[i, scene])) return
  least[i, scene] = $7
  method[i, scene] = $1 ($3 != "" ? ", $" sprintf("10^{%.0f}", log($3) / log(10)) "$" : \
                         $2 > 1 ? "\\,\\texttimes\\,$" $2 "$" : "")
}

function cells(i,  row, s) {
  for (s = 1; s <= scenes; s++)
    row = row ((i, order[s]) in least ? " & " method[i, order[s]] " & " three(1e3 * least[i, order[s]]) \
                                      : " & --- & ")
  return row
}

BEGIN {
  FS = ","
  n = split("0 1 2 3 4 6 8", exponent, " ")
}

FNR == 1 {
  scene = FILENAME
  sub(/.*\//, "", scene)
  sub(/\.csv$/, "", scene)
  if (scene != "impacts") order[++scenes] = scene
}

/^# [a-z A-Z[\]]+: / {
  key = value = $0
  sub(/^# /, "", key)
  sub(/:.*/, "", key)
  sub(/^[^:]*: /, "", value)
  if (key ~ /^(command|machine|compiler|reference|witness)$/) define(key, tex(value))
  if (key == "date") define(key, substr(value, 1, 10))
  if (key ~ /^(masses|springs)$/) define(key, value)
  if (key == "horizon [s]") define("horizon", three(value))
  if (key == "until [s]") define("until", three(value))
  if (key == "reference error [px]") define("own", power(own = value))
}

scene == "impacts" && /^(kept|located),/ {
  if (!($1 in change)) rule[++rules] = $1
  change[$1] = change[$1] " & " percent($4) " .. " percent($5) ($3 < 99 ? ", stopped at " $3 "~s" : "")
}

scene != "impacts" && !/^#/ && $1 != "method" && $4 == 1 {
  for (i = 1; i <= n; i++) consider(i)
}

END {
  print "\\newcommand{\\cheapest}{%"
  for (i = 1; i <= n; i++) print "$" (exponent[i] < 3 ? 10 ^ -exponent[i] : "10^{-" exponent[i] "}") "$" cells(i) " \\\\"
  print "}"
  print "\\newcommand{\\impacts}{%"
  for (i = 1; i <= rules; i++) print "\\emph{" rule[i] "}" change[rule[i]] " \\\\"
  print "}"
}
