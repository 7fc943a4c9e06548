#!/usr/bin/env bats
# What pip lays into an environment: the Python package among its modules, the tools in its bin.
#
# To build a wheel takes many minutes. So the first case lays out the programs of the build that is tested as those of a wheel, and
# what stands where pip lays it has to work. The last one installs a wheel in a fresh environment: that which $GONIOCHROME_WHEEL names.

setup() {
  wheel=${GONIOCHROME_WHEEL:+$(realpath "$GONIOCHROME_WHEEL")}
  cd "$BATS_TEST_TMPDIR"
  top=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
}

# project_says VALUES: these values of pyproject.toml, which Python has as `project`.
project_says() {
  /usr/bin/python3 -c "import tomllib
project = tomllib.load(open('$top/pyproject.toml', 'rb'))
print($1)"
}

# works PREFIX PYTHON: what was installed under the prefix works from there, by its commands and from that Python.
works() {
  local page command
  PATH=$1/bin:/usr/bin:/bin
  for page in "$1"/share/man/man1/*.1 "$1"/share/bash-completion/completions/*; do
    command=$(basename "$page" .1)
    [ "$(command -v "$command")" = "$1/bin/$command" ] || { echo "$command: not in bin"; return 1; }
    "$command" --help >help || { echo "$command: does not start"; return 1; }
    grep -q "$command" help
  done
  [ -s "$1/lib/goniochrome/goniochrome-codecs.so" ]
  [ -s "$1/lib/goniochrome/studio.html" ] || [ ! -f "$GONIOCHROME_BUILD/lib/goniochrome/studio.html" ]
  data=$1/share/goniochrome/testdata
  # The reader of other pictures is found beside the programs.
  relight --quiet --from D65 --to A "$TESTDATA/contact-sheet.jpg" -o warm.exr
  # The five lines of the README: a fit, and a plot of the curve and the readings.
  sed -n '/^    import goniochrome/,/^$/s/^    //p' "$top/README.md" >five.py
  [ "$(grep -c . five.py)" -eq 5 ]
  ln -s "$data" testdata
  "$2" five.py
  # Six readings in three channels, and one in the legend.
  [ "$(grep -o '<circle [^>]*r="3" fill="#000000"' silver.svg | wc -l)" -eq 19 ]
  fit-paint --quiet --basis "$data/b7.basis.xml" "$data/paints.paints.xml#silver_fine" -o tool.paints.xml
  plot-paint --quiet tool.paints.xml -o tool.svg
  cmp silver.svg tool.svg
  prefilter-envmap --quiet --basis "$data/b7.basis.xml" --size 16 "$data/studio.exr" -o studio.env.exr
  render-osmesa --quiet --mesh "$data/speed-shape.obj" --paint tool.paints.xml --env studio.env.exr --size 32x24 -o shape.png
  relight --quiet --from D65 --to A shape.png -o shape.exr
  if [ -s "$1/lib/goniochrome/studio.html" ]; then
    paint-studio --quiet --mesh "$data/speed-shape.obj" --env studio.env.exr --basis "$data/b7.basis.xml" "$data/paints.paints.xml" -o page.html
    [ -s page.html ]
    paint-studio --quiet --empty -o empty.html
    [ -s empty.html ]
  fi
  printf 'sample,geometry,illuminant,observer,L,a,b\none,45as15,D65,10,50,10,5\none,45as45,D65,10,40,8,4\none,45as110,D65,10,30,6,3\n' >one.csv
  paint-book one.csv --basis "$data/b5.basis.xml" --size 32x24 --quiet -o one.html
  [ -s one.html ]
}

@test "the programs of this build work where pip lays them" {
  [ -f "$GONIOCHROME_BUILD/python/goniochrome/libgoniochrome.so" ] || skip "this build has no Python module: a sanitizer is in the way"
  /usr/bin/python3 -c 'import numpy' || skip "python3-numpy is not there"
  mkdir build env
  cmake -S "$top" -B build -G Ninja -DSKBUILD=2 -DSKBUILD_SCRIPTS_DIR="$PWD/wheel/scripts" -DSKBUILD_DATA_DIR="$PWD/wheel/data" \
    -DGONIOCHROME_TESTS=OFF >log 2>&1 || { cat log; false; }
  rm -rf build/bin build/lib/goniochrome build/python/goniochrome
  ln -s "$GONIOCHROME_BUILD/bin" build/bin
  ln -s "$GONIOCHROME_BUILD/lib/goniochrome" build/lib/goniochrome
  ln -s "$GONIOCHROME_BUILD/python/goniochrome" build/python/goniochrome
  for component in $(project_says '*project["tool"]["scikit-build"]["install"]["components"]'); do
    cmake --install build --prefix wheel/platlib --component "$component" >>log
  done
  [ "$(ls wheel | xargs), $(ls wheel/platlib | xargs)" = "data platlib scripts, goniochrome" ] || { ls wheel wheel/platlib; false; }
  # A wheel keeps no links.
  [ -z "$(find wheel -type l)" ] || { find wheel -type l; false; }
  cp -rl wheel/data/. env
  cp -rl wheel/scripts env/bin
  # What the folders of the wheel and of the build say must not matter.
  mv wheel away
  rm -r build
  PYTHONPATH=$PWD/away/platlib works "$PWD/env" /usr/bin/python3
}

@test "a wheel bears the version of the project" {
  [ "$(project_says 'project["project"]["version"]')" = "$(fit-paint --version | cut -d' ' -f2)" ]
}

# foreign PREFIX PATH...: what the programs and libraries there load from outside the prefix, but the C library, libstdc++ and libgcc_s.
foreign() {
  local file prefix=$1
  shift
  find "$@" -type f | while read -r file; do
    [ "$(head -c 4 "$file" | tr -d '\0')" = $'\x7fELF' ] || continue
    ldd "$file" | grep -vE "$prefix/|statically linked|linux-vdso|ld-linux|lib(c|m|dl|pthread|rt|stdc\+\+|gcc_s)\.so" | sed "s|^|${file##*/}:|" || true
  done
}

@test "the wheel that GONIOCHROME_WHEEL names works in a fresh environment, with libraries of its own" {
  [ -n "$wheel" ] || skip "GONIOCHROME_WHEEL names no wheel; scripts/make-wheel makes one"
  /usr/bin/python3 -m venv env || skip "python3-venv is not installed"
  env/bin/pip install "$wheel"
  foreign "$PWD/env" env/bin env/lib/goniochrome env/lib/python3*/site-packages/goniochrome >foreign
  [ ! -s foreign ] || { cat foreign; false; }
  # The control: a program of the system loads other libraries from there.
  [ -n "$(foreign "$PWD/env" "$(command -v oiiotool)")" ]
  [ "$(stat -c %s "$wheel")" -le 80000000 ]
  unset PYTHONPATH
  works "$PWD/env" env/bin/python
}
