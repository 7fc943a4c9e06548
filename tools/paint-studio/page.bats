# The page itself: its arithmetic beside that of the tools, its picture beside that of render-osmesa, and a designer's path
# through it. Node runs the arithmetic, and Chromium the rest; cases are skipped where one of them is missing.

bats_require_minimum_version 1.5.0

setup_file() {
  export code=$BATS_TEST_DIRNAME/browser
  module=$(dirname "$(command -v paint-studio)")/../lib/goniochrome/studio.wasm
  export module
  cd "$BATS_FILE_TMPDIR" || exit 1
  [ -f "$module" ] || return 0
  for light in studio outdoor; do
    prefilter-envmap -q "$TESTDATA/$light.exr" --basis "$TESTDATA/b5.basis.xml" -o "$light.env.exr"
  done
  paint-studio -q --mesh "$TESTDATA/speed-shape.obj" --env studio.env.exr --env outdoor.env.exr \
    --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o page.html
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  [ -f "$module" ] || skip "there was no compiler for WebAssembly when the tools were built"
  command -v node >/dev/null || skip "Node is not installed"
}

needs_browser() {
  [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "Chromium is not installed"
}

# The two C libraries differ in the last bits of sines, roots and logarithms. An edit multiplies that by the condition of a
# few sums, and a fit by that of its equations, some 1e3: 1e-11 and 1e-8 are far above it and far below what is seen.
@test "edits, fits and nearest paints are those of the tools" {
  run node "$code/identity.js" "$module" "$TESTDATA/b5.basis.xml" "${GONIOCHROME_TRIALS:-320}" 7
  echo "$output"
  [ "$status" -eq 0 ]
  for what in edits fits "nearest paints"; do
    line=$(grep "^$what:" <<<"$output")
    [[ "$line" =~ ", 0 of another form, the others within "([0-9.e+-]+)$ ]]
    bound=1e-11
    [ "$what" = fits ] && bound=1e-8
    awk -v worst="${BASH_REMATCH[1]}" -v bound=$bound 'BEGIN { exit !(worst <= bound) }'
  done
}

@test "the picture is that of render-osmesa, in four paints and two lights" {
  needs_browser
  fit-paint -q -b "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  run node "$code/pictures.js" page.html . 640x360 candy_red silver_black_flop blue_to_purple green_to_gold
  echo "$output"
  [ "$status" -eq 0 ]
  for light in studio outdoor; do
    white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' page.html |
      jq ".environments[] | select(.name == \"$light\").white")
    for paint in candy_red silver_black_flop blue_to_purple green_to_gold; do
      render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" --paint "fitted.xml#$paint" --env "$light.env.exr" --engine gl \
        --effects all,-rays --size 640x360 --samples 1 -o "$paint-$light.exr"
      run /usr/bin/python3 "$code/compare.py" "$paint-$light.f32" "$paint-$light.exr" "$white"
      echo "$paint $light: mean p95 largest pixels: $output"
      awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.1 && n[2] <= 0.5 && n[4] > 20000) }'
    done
  done
}

@test "a designer's path by mouse and keyboard makes the paint that the shown commands make" {
  needs_browser
  run node "$code/path.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
  bash -euo pipefail command.txt
  fit-paint -q -b "$TESTDATA/b5.basis.xml" saved.paints.xml -o by-tools.xml
  paint-convert -q design.paints.xml --columns all -o theirs.csv
  paint-convert -q saved.fitted.paints.xml --columns all -o ours.csv
  # The readings are equal to nine digits, since two C libraries made them.
  python3 - theirs.csv ours.csv <<'PY'
import csv, sys
one, two = (list(csv.reader(open(path))) for path in sys.argv[1:])
assert len(one) == len(two) > 1
for a, b in zip(one, two):
    for x, y in zip(a, b):
        try:
            assert abs(float(x) - float(y)) <= 1e-9 * max(1, abs(float(x))), (x, y)
        except ValueError:
            assert x == y, (x, y)
PY
  cp "$TESTDATA/paints.paints.xml" library.paints.xml  # an index is written beside it
  colorsnap -q --library library.paints.xml saved.paints.xml >/dev/null || [ $? -eq 1 ]
  grep -q '^sample,geometry,illuminant' saved.csv
}
