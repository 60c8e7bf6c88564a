#!/bin/sh
# check_docs.sh - what the documents show is true: each block of C that follows a line
# `<!-- FILE -->` stands in that file word for word, the README's program compiles and runs on an
# example scene, and every file that a document links to is there.
#
# Environment: BUILD, CC, PKG_CONFIG.
set -eu
cd "$(dirname "$0")/.."
build=${BUILD:-build}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

# Each quoted block into its own file, whose first line is the name of the file that it is from.
awk -v dir="$tmp" '
  /^<!-- .* -->$/ { from = $2; next }
  /^```c$/ { out = dir "/quote-" ++n; print (from ? from : "-") > out; from = ""; next }
  /^```$/ { if (out) close(out); out = ""; next }
  out { print > out }' README.md docs/*.md

quoted=0
for quote in "$tmp"/quote-*; do
  file=$(head -n 1 "$quote")
  sed 1d "$quote" >"$tmp/block.c"
  [ "$file" != - ] || continue
  awk 'FNR == NR { block = block $0 "\n"; next } { text = text $0 "\n" }
       END { exit !index(text, block) }' "$tmp/block.c" "$file" ||
    { echo "a quote isn't in $file:"; cat "$tmp/block.c"; exit 1; }
  quoted=$((quoted + 1))
done
echo "$quoted quotes found where they say"
[ $quoted -gt 0 ]

awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' README.md >"$tmp/program.c"
${CC:-cc} -std=c11 -Wall -Wextra -Werror -Iinclude "$tmp/program.c" -o "$tmp/program" \
  "$build/libmsr.a" $(${PKG_CONFIG:-pkg-config} --libs gsl)
cp examples/scenes/assignment.ppm "$tmp/scene.ppm"
cp examples/scenes/assignment.conf "$tmp/scene.conf"
(cd "$tmp" && ./program)

for document in README.md docs/*.md examples/*.md; do
  grep -o '](\([^)#]*\))' "$document" | sed 's/^](//; s/)$//' | grep -v '^[a-z]*:' | while read -r link; do
    [ -e "$(dirname "$document")/$link" ] || { echo "$document links to $link: not there"; exit 1; }
  done
done
