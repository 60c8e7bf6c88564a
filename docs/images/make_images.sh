#!/bin/sh
# make_images.sh - makes the pictures of this directory: frames of examples/scenes, side by side, and
# a work-precision diagram.
# It needs ImageMagick, gnuplot and the command: MSR, or build/msr.
set -eu
cd "$(dirname "$0")/../.."
msr=${MSR:-build/msr}
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

# strip OUTPUT SCENE COLUMNSxROWS FRAME...: a scene is run with the options that its conf names.
strip() {
  output=$1 scene=examples/scenes/$2 tiles=$3 dir=$frames/$2
  shift 3
  options=$(sed -n 's/^# msr [^ ]* [^ ]*//p' "$scene.conf")
  [ -d "$dir" ] || "$msr" "$scene.ppm" "$scene.conf" $options -q -o "$dir"
  for frame; do
    set -- "$@" "$dir/frame-$(printf %06d "$frame").ppm"
    shift
  done
  montage "$@" -tile "$tiles" -filter point -resize '320x320>' -geometry +3+3 -background '#bbb' \
    -colors 64 -define png:compression-level=9 -strip "docs/images/$output.png"
}

strip msr        letters    3x2  0 40 50 60 90 150
strip assignment assignment 4x1  0 30 60 500
strip big        big        4x1  0 45 70 149
strip blocks     blocks     4x1  0 60 100 299
strip bridge     bridge     4x1  0 28 50 70
strip flag       flag       4x1  0 55 100 200
strip heap       heap       4x1  0 40 80 199
strip jelly      jelly      4x1  0 50 80 120
strip laundry    laundry    4x1  0 50 90 160
strip letters    letters    4x1  0 50 120 374
strip pendulum   pendulum   4x1  0 15 30 42
strip rope       rope       4x1  0 30 60 120
strip stairs     stairs     4x1  0 100 200 300
strip trampoline trampoline 4x1  0 40 75 180
strip turn       turn       4x1  0 12 24 34

# The guide's.
"$msr" accuracy examples/scenes/rope.ppm examples/scenes/rope.conf --attach --until 0.2 \
  --plot "$frames/accuracy.png" > "$frames/accuracy.txt"
convert "$frames/accuracy.png" -resize 50% -colors 64 -define png:compression-level=9 -strip \
  docs/images/accuracy.png

# The README's: every third frame of nine seconds, in real time.
convert -delay 12 $(seq -f "$frames/letters/frame-%06.0f.ppm" 0 3 220) -colors 8 \
  -layers optimize docs/images/msr.gif
