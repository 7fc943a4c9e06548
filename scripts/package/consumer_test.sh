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
# Every page of man1 and every completion is that of a command, which finds its modules.
for page in "$folder"/moved/share/man/man1/*.1 "$folder"/moved/share/bash-completion/completions/*; do
  "$folder/moved/bin/$(basename "$page" .1)" --help >"$folder/help" || {
    echo "$page: there is no such command in bin"
    exit 1
  }
  grep -q "$(basename "$page" .1)" "$folder/help"
done
for command in paint-book paint-batch accuracy-report paint-studio; do
  [ -s "$folder/moved/share/man/man1/$command.1" ] && [ -s "$folder/moved/share/bash-completion/completions/$command" ] || {
    echo "not installed: the manual of $command"
    exit 1
  }
done
# A script takes the tools that were installed with it, and no others of their names.
mkdir "$folder/others"
printf '#!/bin/sh\nexit 70\n' | tee "$folder/others/render-osmesa" >"$folder/others/paint-convert"
chmod +x "$folder"/others/*
(
  cd "$folder"
  PATH=$folder/others:$PATH
  data=$folder/moved/share/goniochrome/testdata
  paint-convert --version && exit 1
  printf 'sample,geometry,illuminant,observer,L,a,b\none,45as15,D65,10,50,10,5\none,45as45,D65,10,40,8,4\none,45as110,D65,10,30,6,3\n' >one.csv
  moved/bin/paint-book one.csv --basis "$data/b5.basis.xml" --size 32x24 --quiet -o one.html
  moved/bin/paint-batch plan one.csv --out batch --size 32x24 --env-size 16
  moved/bin/paint-batch shard batch 0
  moved/bin/paint-batch merge batch
  grep -q '1 pictures' <(moved/bin/paint-batch merge batch 2>&1)
)
for file in bin/fit-paint lib/goniochrome/goniochrome-codecs.so share/man/man1/fit-paint.1 share/man/man5/goniochrome-paint.5 \
  share/bash-completion/completions/fit-paint share/goniochrome/paint.xsd share/goniochrome/testdata/studio.exr; do
  [ -s "$folder/moved/$file" ] || {
    echo "not installed: $file"
    exit 1
  }
done
for file in goniochrome.7.html gallery/gloss.jpg; do
  [ ! -f "$build/html/index.html" ] || [ -s "$folder/moved/share/doc/goniochrome/html/$file" ] || {
    echo "not installed: the pages as HTML: $file"
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
