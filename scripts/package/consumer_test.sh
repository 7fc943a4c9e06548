#!/usr/bin/env bash
# Installs a build into a folder of its own, and builds and runs a program of another project against it.
#
#   consumer_test.sh BUILD [CXX]
set -euo pipefail
build=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

DESTDIR= cmake --install "$build" --prefix "$folder/prefix" >/dev/null
# The prefix is moved before it is used, so that a path of the build folder or of the prefix would be found out.
mv "$folder/prefix" "$folder/moved"
cmake -S "$here/consumer" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/moved" ${2:+-DCMAKE_CXX_COMPILER="$2"} \
  -DCMAKE_CXX_FLAGS="${CXXFLAGS:-}" >"$folder/log" 2>&1 || {
  cat "$folder/log"
  exit 1
}
cmake --build "$folder/build"
"$folder/build/consumer" "$folder/moved/share/goniochrome/testdata/b7.basis.xml"
"$folder/moved/share/goniochrome/scripts/paint-book" --help >/dev/null
"$folder/moved/share/goniochrome/scripts/batch/paint-batch" --help >/dev/null
for file in bin/fit-paint lib/goniochrome/goniochrome-oiio.so share/man/man1/fit-paint.1 share/man/man5/goniochrome-paint.5 \
  share/bash-completion/completions/fit-paint share/goniochrome/paint.xsd share/goniochrome/testdata/studio.exr; do
  [ -s "$folder/moved/$file" ] || {
    echo "not installed: $file"
    exit 1
  }
done
# The page of paint-studio is there where the compiler for WebAssembly is.
for file in lib/goniochrome/studio.wasm lib/goniochrome/studio.html; do
  [ ! -f "$build/lib/goniochrome/studio.wasm" ] || [ -s "$folder/moved/$file" ] || {
    echo "not installed: $file"
    exit 1
  }
done
