#!/usr/bin/env bash
# Behaviour tests of the command: runs every tests/cli/*.test, or those named, each in its own
# fresh directory, where in/ holds a copy of scenes/.
#
#   MSR=path/to/msr tests/cli/run.sh [CASE.test ...]
#
# A case is a list of steps; a line begins with one of
#   #  a comment
#   ?  a shell command: the case is skipped unless it succeeds
#   $  a step: a shell command (bash), in which msr is the command under test
#   =  its exit status, if that isn't 0
#   >  a line of its standard output, !  a line of its standard error: globs, of whole lines;
#      `...` stands for all the lines that are left, be there any or none. No line: no output.
set -u
export LC_ALL=C here

here=$(cd "$(dirname "$0")" && pwd)
MSR=$(realpath "${MSR:-$here/../../build/msr}")
[ -x "$MSR" ] || { echo "run.sh: $MSR is no program; build it, or set MSR" >&2; exit 2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$MSR" "$scratch/bin/msr"
PATH=$scratch/bin:$PATH

# Compares a file with the globs that its lines should match; prints a diff if they don't. A line
# that matches its glob stands for it in the diff.
compare() {
  local name=$1 actual=$2 i=0 glob lines
  shift 2
  mapfile -t lines <"$actual"
  for glob; do
    if [ "$glob" = ... ]; then
      for (( ; i < ${#lines[@]}; i++)); do printf '%s\n' "${lines[i]}"; done
    elif ((i < ${#lines[@]})) && [[ ${lines[i]} == $glob ]]; then
      printf '%s\n' "${lines[i]}"
    else
      printf '%s\n' "$glob"
    fi
    ((i++))
  done >"$scratch/expected"
  diff -u --label "$name expected" --label "$name" "$scratch/expected" <(printf '%s\n' "${lines[@]}" |
    if ((${#lines[@]})); then cat; fi)
}

# Runs the step in command, status, out and err, for a minute at most; false if anything differs.
run_step() {
  local failed=0 got
  (cd "$scratch/case" && exec timeout 60 bash -c "$command") >"$scratch/out" 2>"$scratch/err" </dev/null
  got=$?
  if [ "$got" != "$status" ]; then
    echo "exit status $got, expected $status"
    failed=1
  fi
  compare stdout "$scratch/out" "${out[@]}" || failed=1
  compare stderr "$scratch/err" "${err[@]}" || failed=1
  return $failed
}

# 0 passed, 1 failed (what went wrong is printed), 2 skipped.
run_case() {
  local line text command='' status=0 out=() err=()
  rm -rf "$scratch/case"
  mkdir "$scratch/case"
  cp -r "$here/scenes" "$scratch/case/in"
  while IFS= read -r line || [ -n "$line" ]; do
    text=${line#? }
    case $line in
      '#'* | '') ;;
      '? '*) (eval "$text") >/dev/null 2>&1 </dev/null || return 2 ;;
      '= '*) status=$text ;;
      '> '* | '>') out+=("${line:2}") ;;
      '! '* | '!') err+=("${line:2}") ;;
      '$ '*)
        if [ -n "$command" ] && ! run_step; then echo "after: $command"; return 1; fi
        command=$text status=0 out=() err=()
        ;;
      *) echo "not a line of a test: $line"; return 1 ;;
    esac
  done <"$1"
  [ -n "$command" ] || { echo "no step"; return 1; }
  run_step || { echo "after: $command"; return 1; }
}

passed=0 failed=0 skipped=0
[ $# -gt 0 ] || set -- "$here"/*.test
for case; do
  report=$(run_case "$case")
  case $? in
    0) ((passed++)) ;;
    2) ((skipped++)) ;;
    *)
      ((failed++))
      printf 'FAIL %s\n%s\n' "$(basename "$case")" "$report"
      ;;
  esac
done
[ "$skipped" = 0 ] || echo "$skipped skipped: a tool that they need isn't there"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
