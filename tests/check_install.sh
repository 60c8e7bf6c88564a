#!/bin/sh
# check_install.sh - installs into a temporary prefix, builds each example against it as a user does
# (pkg-config, shared and static), runs it, and sees that uninstall leaves nothing behind.
#
# Environment: MAKE, CC, PKG_CONFIG.
set -eu
cd "$(dirname "$0")/.."
make="${MAKE:-make} -s"
cc=${CC:-cc}
pkg_config=${PKG_CONFIG:-pkg-config}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
prefix=$tmp/prefix

files() { (cd "$1" && find . ! -type d | sort); }

$make install DESTDIR= PREFIX="$prefix" LIBDIR="$prefix/lib"
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
version=$($pkg_config --modversion msr)
"$prefix/bin/msr" --version | grep -F "$version"

mkdir "$tmp/static"
cp -r "$prefix/share/doc/msr" "$tmp/run"
cp "$prefix/lib/libmsr.a" "$tmp/static"
for source in examples/*.c; do
  name=$(basename "$source" .c)
  "$cc" "$source" -o "$tmp/$name" $($pkg_config --cflags --libs msr)
  "$cc" "$source" -o "$tmp/$name-static" -L"$tmp/static" \
    $($pkg_config --static --cflags --libs msr)
  for run in "env LD_LIBRARY_PATH=$prefix/lib $tmp/$name" "$tmp/$name-static"; do
    (cd "$tmp/run" && $run) >"$tmp/out" 2>&1 || { echo "$run failed:"; cat "$tmp/out"; exit 1; }
  done
done

$make install DESTDIR="$tmp/stage" PREFIX=/opt/msr LIBDIR=/opt/msr/lib
[ "$(files "$tmp/stage/opt/msr")" = "$(files "$prefix")" ]
grep -qx 'prefix=/opt/msr' "$tmp/stage/opt/msr/lib/pkgconfig/msr.pc"

$make uninstall DESTDIR= PREFIX="$prefix" LIBDIR="$prefix/lib"
$make uninstall DESTDIR="$tmp/stage" PREFIX=/opt/msr LIBDIR=/opt/msr/lib
left=$(find "$prefix" "$tmp/stage" ! -type d -o -path '*doc/msr')
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
