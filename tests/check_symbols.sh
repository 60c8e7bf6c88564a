#!/bin/sh
# check_symbols.sh - libmsr.so exports what include/msr.h declares and nothing else, all of it named
# msr_*; whatever else libmsr.a defines for its own files is named msri_*.
set -eu
cd "$(dirname "$0")/.."
build=${BUILD:-build}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

names() { awk 'NF == 3 { print $3 }' | sort; }

nm -D --defined-only "$build/libmsr.so" | names >"$tmp/exported"
sed -n 's/^MSR_API.*[ *]\(msr_[a-z0-9_]*\)[(;[].*/\1/p' include/msr.h | sort >"$tmp/declared"
[ -s "$tmp/declared" ]
diff "$tmp/declared" "$tmp/exported" |
  sed -n 's/^< /declared but not exported: /p; s/^> /exported but not declared: /p' >"$tmp/wrong"
grep -v '^msr_' "$tmp/exported" >>"$tmp/wrong" || true
nm -g --defined-only "$build/libmsr.a" | names | grep -v '^msri*_' >>"$tmp/wrong" || true
cat "$tmp/wrong"
[ ! -s "$tmp/wrong" ]
