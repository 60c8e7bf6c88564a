#!/bin/sh
# run.sh - runs test programs and scripts and ends in the line `N passed, N failed`.
#
# usage: run.sh PROGRAM|SCRIPT.sh...
# A program prints its tests in TAP, as cmocka does. A script that ends in `N passed, N failed` ran
# so many tests (a line `N skipped` says how many not); any other is one test, judged by its status.
# A crash, a leak, a test that was planned and didn't run, or no test at all is a failure.
#
# Environment: BUILD (absolute), RUNNER (a command that runs programs: valgrind), LIMIT (seconds).
set -u
cd "$(dirname "$0")/.."

export BUILD="${BUILD:-$PWD/build}"
export MSR="$BUILD/msr"
export CMOCKA_MESSAGE_OUTPUT=TAP
export ASAN_OPTIONS="allocator_may_return_null=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
[ ! -d "$BUILD/locale" ] || export LOCPATH="$BUILD/locale"
runner=${RUNNER:-}
limit=${LIMIT:-600}
passed=0 failed=0 skipped=0
mkdir -p "$BUILD/tests"
tmp=$(mktemp -d "$BUILD/tests/tmp.XXXXXX")
export TMPDIR="$tmp"
log=$tmp/log
trap 'rm -rf "$tmp"' EXIT
trap 'exit 130' INT TERM

# The tests that the log tells of, as `passed failed skipped missing`.
count_tap() {
  awk '/^1\.\.[0-9]+$/ { planned += substr($0, 4) }
       /^(not )?ok .*# SKIP/ { skipped++; next }
       /^ok / { passed++ }
       /^not ok / { failed++ }
       END {
         print passed + 0, failed + 0, skipped + 0, planned - passed - failed - skipped
       }' "$log"
}
count_script() { # exit status
  awk -v status="$1" '
    /^[0-9]+ skipped/ { skipped = $1 }
    { last = $0 }
    END {
      if (last !~ /^[0-9]+ passed, [0-9]+ failed/) last = (status == 0) " passed, " (status != 0)
      split(last, word, " ")
      print word[1], word[3], skipped + word[5], 0
    }' "$log"
}

for test in "$@"; do
  name=${test#"$BUILD"/}
  name=${name##*tests/}
  if [ -n "$runner" ]; then
    timeout 2 "$test" >/dev/null 2>&1 </dev/null
    [ $? -ne 124 ] || { printf '%-28s takes too long for %s\n' "$name" "${runner%% *}"; continue; }
  fi
  start=$(date +%s%N)
  case $test in
  *.sh) command=$(sed -n '1s/^#!//p' "$test") ;;
  *) command=$runner ;;
  esac
  timeout -k 5 "$limit" $command "$test" >"$log" 2>&1 </dev/null
  status=$?
  milliseconds=$((($(date +%s%N) - start) / 1000000))

  case $test in *.sh) count_script $status ;; *) count_tap ;; esac >"$tmp/count"
  read -r ok bad skip missing <"$tmp/count"
  why=
  [ $((ok + bad + skip)) -gt 0 ] || why='no test ran'
  [ "$missing" -eq 0 ] || why="$missing tests did not run, or ran twice"
  [ $status -eq 0 ] || why="exit status $status"
  [ $status -ne 124 ] || why="stopped after $limit s"
  [ -z "$why" ] || [ "$bad" -gt 0 ] || bad=1

  printf '%-28s %4d tests %4d.%03d s' "$name" $((ok + bad + skip)) \
    $((milliseconds / 1000)) $((milliseconds % 1000))
  [ "$skip" -eq 0 ] || printf ', %d skipped' "$skip"
  [ "$bad" -eq 0 ] || printf ', %d FAILED (%s)' "$bad" "${why:-see below}"
  echo
  [ "$bad" -eq 0 ] || sed 's/^/    /' "$log"
  passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
done

[ $((passed + failed)) -gt 0 ] || failed=1
[ "$skipped" -eq 0 ] && skipped= || skipped=", $skipped skipped"
echo "$passed passed, $failed failed$skipped"
[ "$failed" -eq 0 ]
