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

# The readings of two tables are equal to nine digits.
same_readings() {
  python3 - "$@" <<'PY'
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
}

needs_browser() {
  [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "Chromium is not installed"
}

# Runs a script on a page; NAME.json has the figures that it prints.
figures() {
  run node "$code/$1.js" "${@:2}"
  echo "$output"
  [ "$status" -eq 0 ]
  grep '^{' <<<"$output" >"$1.json"
}

# The elementary functions are the project's own, so that nothing differs: see lib/math/elementary.h.
@test "edits, fits, metrics and nearest paints are those of the tools to the last bit" {
  run node "$code/identity.js" "$module" "$TESTDATA/b5.basis.xml" "${GONIOCHROME_TRIALS:-320}" 7
  echo "$output"
  [ "$status" -eq 0 ]
  for what in edits fits metrics "nearest paints"; do
    line=$(grep "^$what:" <<<"$output")
    [[ "$line" =~ ^"$what: "([0-9]+)" of "([0-9]+)" identical to the last bit, 0 of another form" ]]
    [ "${BASH_REMATCH[1]}" -ge 300 ]
    [ "${BASH_REMATCH[1]}" -eq "${BASH_REMATCH[2]}" ]
  done
}

@test "the picture is that of render-osmesa, in four paints and two lights" {
  needs_browser
  fit-paint -q -b "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  figures pictures page.html . 640x360 candy_red silver_black_flop blue_to_purple green_to_gold
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

# A half float rounds a layer by at most 4.9e-4 of its value, and few channels are one layer alone. The control takes the layers
# of another paint, whose wide lobes look elsewhere.
@test "a picture from layers of gathered light is that of the shading program" {
  [ -s pictures.json ] || skip "the pictures were not drawn"
  [ "$(jq '.layers | length == 8 and map(.p95 <= 4.9e-4) == [range(8) | true]' pictures.json)" = true ]
  figures layers page.html . 640x360 candy_red
  [ "$(jq '[.moved, .lamp, .little] | map(.p95 <= 4.9e-4) | all' layers.json)" = true ]
  [ "$(jq '.shift > 1e-3 and .control.p95 > 4.9e-4' layers.json)" = true ]
  [ "$(jq '.full and .layers_drawn > 8 and .layer_bytes <= 96e6' layers.json)" = true ]
  [ "$(jq -r .refused layers.json)" = "There is no room for the layers of this picture." ]
  [ "$(jq '.smooth | .strided and .off < 0.25 * .off_plain' layers.json)" = true ]
  [ "$(jq .timers layers.json)" -eq 1 ]  # steps to the sharp picture wait for what is drawn, and for no more
}

# Most of the ground is so far from the mesh that nothing takes its light away.
@test "the ground lies where render-osmesa lays it, with the shadow of the mesh" {
  needs_browser
  [ -s pictures.json ] || skip "the pictures were not drawn"
  figures grounds page.html . 640x360 candy_red
  [ "$(jq '.search | all' grounds.json)" = true ]
  [ "$(jq '.in_turn | map(.again == 0 and .between == 0 and .other > 0.1) | all' grounds.json)" = true ]
  for light in studio outdoor; do
    white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' page.html |
      jq ".environments[] | select(.name == \"$light\").white")
    render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" -p "fitted.xml#candy_red" --env "$light.env.exr" \
      --background env --floor shadow --size 640x360 --samples 1 --aov mask --tolerance 0.5 -o "ground-$light.exr"
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light.f32" "ground-$light.exr" "$white" beside
    echo "$light: mean p95 largest pixels median: $output"
    awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[4] > 100000 && n[5] <= 0.1) }'
    # The controls lack the light that the mesh sends to the ground, and then the shadow too.
    awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.15 && n[2] <= 0.4) }'
    shaded=${output%% *}
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light-unsent.f32" "ground-$light.exr" "$white" beside
    echo "$light without light from the mesh: $output"
    awk -v shaded="$shaded" -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] > 1.5 * shaded) }'
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light-shadeless.f32" "ground-$light.exr" "$white" beside
    echo "$light without shadow: $output"
    awk -v shaded="$shaded" -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] > 1.5 * shaded && n[2] > 4) }'
    # The page finds the shadow as well; and that of the mesh on itself, without which the control is.
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light-found.f32" "ground-$light.exr" "$white" beside
    echo "$light, shadow found by the page: $output"
    awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.36 && n[2] <= 1.3) }'
    for what in shaded found; do
      run /usr/bin/python3 "$code/compare.py" "candy_red-$light-$what.f32" "ground-$light.exr" "$white"
      echo "$light, mesh, $what: $output"
      awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.87 && n[2] <= 2.9) }'
    done
    shaded=${output%% *}
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light.f32" "ground-$light.exr" "$white"
    echo "$light, mesh without shadow: $output"
    awk -v shaded="$shaded" -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] > 1.15 * shaded) }'
    # The control: the environment far away, as it is without the ground.
    run /usr/bin/python3 "$code/compare.py" "candy_red-$light-groundless.f32" "ground-$light.exr" "$white" beside
    echo "$light without ground: $output"
    awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[5] > 0.5) }'
  done
}

# Two views with floors of both kinds, traced in a paint that is none of the four.
@test "traced views show every paint as render-osmesa --gbuffer does" {
  needs_browser
  paints=(candy_red silver_black_flop blue_to_purple green_to_gold)
  fit-paint -q -b "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  traced() { render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" -p fitted.xml#silver_fine --size 160x90 --samples 1 \
    --engine path --aov transport --tolerance 6 "$@"; }
  traced --env studio.env.exr --floor shadow --background env -o studio-view.exr
  traced --env outdoor.env.exr --floor fitted.xml#signal_white --camera -40,20 -o outdoor-view.exr
  paint-studio -q --mesh "$TESTDATA/speed-shape.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" \
    --transport studio-view.exr --transport outdoor-view.exr "$TESTDATA/paints.paints.xml" -o views.html --report views.json
  [ "$(jq '.results.transports | length' views.json)" -eq 2 ]
  [ "$(jq '.results.transports | map(.rounding_de00_p95 <= 0.1) | all' views.json)" = true ]
  run node "$code/views.js" views.html . "${paints[@]}"
  echo "$output"
  [ "$status" -eq 0 ]
  for view in studio-view outdoor-view; do
    white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' views.html |
      jq ".views[] | select(.name == \"$view\").white")
    for paint in "${paints[@]}"; do
      render-osmesa -q --trim --gbuffer "$view.exr" -p "fitted.xml#$paint" --tolerance 100 -o "$paint-$view.exr"
      run /usr/bin/python3 "$code/compare.py" "$paint-$view.f32" "$paint-$view.exr" "$white"
      echo "$paint $view: mean p95 largest pixels: $output"
      awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.1 && n[2] <= 0.5 && n[4] > 10000) }'
    done
  done
  # The control: another paint is far off.
  run /usr/bin/python3 "$code/compare.py" candy_red-studio-view.f32 green_to_gold-studio-view.exr 1
  awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] > 2) }'
}

@test "paints come into the page and leave it as the tools have them" {
  needs_browser
  cp "$TESTDATA/paints.paints.xml" library.paints.xml
  paint-studio -q --mesh "$TESTDATA/box.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" library.paints.xml -o files.html
  run node "$code/files.js" files.html . "$TESTDATA/travel.paints.xml"
  echo "$output"
  [ "$status" -eq 0 ]
  jq -r '.[]' opened.json | grep -v '<processing' >opened.xml
  diff <(grep -E '<(paint|lab|face|flop|gloss) ' "$TESTDATA/travel.paints.xml") <(grep -E '<(paint|lab|face|flop|gloss) ' opened.xml)
  # An end that was edited is a file of its own, so that every shell runs the commands.
  grep -q 'gradient.from.paints.xml' gradient-command.txt
  sh -eu gradient-command.txt
  paint-convert -q design.paints.xml --columns all -o theirs.csv
  paint-convert -q gradient.fitted.paints.xml --columns all -o ours.csv
  same_readings theirs.csv ours.csv
  # The CxF has the readings of the design, under the code of the nearest paint.
  paint-convert -q gradient.cxf -o from-cxf.xml
  code=$(sed -n 's/.*code \([^ ]*\) of the nearest paint.*/\1/p' cxf-status.txt)
  [ -z "$code" ] || grep -q "code=\"$code\"" from-cxf.xml
  diff <(grep '<lab ' gradient.fitted.paints.xml) <(grep '<lab ' from-cxf.xml)
}

@test "flakes are read, edited, taken back and written as paint-edit has them" {
  needs_browser
  paint-edit -q "$TESTDATA/paints.paints.xml#silver_fine" --flakes 40,0.2,0.7 --rename stated --code K1 -o stated.paints.xml
  paint-studio -q --mesh "$TESTDATA/speed-shape.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" \
    "$TESTDATA/paints.paints.xml" stated.paints.xml -o flakes.html
  run node "$code/flakes.js" flakes.html .
  echo "$output"
  [ "$status" -eq 0 ]
  bash -euo pipefail flakes-command.txt
  grep -q '<flakes diameter_um="40" coverage="0.31" spread_deg="0.7"/>' flakes-saved.xml
  ! grep -q ' code=' flakes-saved.xml || false
  diff <(grep -E '<(paint|flakes|lab) ' flakes-saved.xml) <(grep -E '<(paint|flakes|lab) ' design.paints.xml)
}

# A plate under the lamp, from four distances. The page counts other flakes than render-osmesa, so that shares differ by what
# 240 x 240 pixels tell: a tenth where many flakes are seen. In the last view the mean has a standard error of .02 dE00.
@test "single flakes have the contrast that render-osmesa draws, and keep the mean color" {
  needs_browser
  printf 'v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nf 1 2 3 4\n' >plate.obj
  paint-edit -q "$TESTDATA/paints.paints.xml#silver_fine" --flakes 40,0.2,0.7 --rename stated -o stated.paints.xml
  fit-paint -q -b "$TESTDATA/b5.basis.xml" stated.paints.xml -o stated.fitted.xml
  paint-studio -q --mesh plate.obj --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" stated.paints.xml "$TESTDATA/paints.paints.xml" -o plate.html
  white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' plate.html | jq '.environments[0].white')
  run node "$code/sparkle.js" plate.html . 240 1,5.7 3,7.6 10,20
  echo "$output"
  [ "$status" -eq 0 ]
  for view in 1,5.7 3,7.6 10,20; do
    meters=${view%,*}
    for effect in + -; do
      render-osmesa -q --mesh plate.obj --paint stated.fitted.xml --env studio.env.exr --engine gl --effects "all,-rays,${effect}sparkle" --size 240x240 \
        --samples 1 --camera "0,0,$meters,0,0,0,${view#*,}" --light "12,2,$white,$white,$white@4" -o "$effect$meters.exr"
    done
    run /usr/bin/python3 "$code/grain.py" "plain-$meters.f32" "flaky-$meters.f32" "./-$meters.exr" "./+$meters.exr"
    echo "$meters m: $output"
    awk -v page="${lines[0]}" -v tool="${lines[1]}" 'BEGIN { split(page, a, " "); split(tool, b, " ")
      for (i = 1; i <= 5; ++i) if (!(a[1] > 0.02 && (a[i] - b[i])^2 <= (0.1 * b[i] + 0.002)^2)) exit 1 }'
  done
  awk -v mean="${lines[2]}" 'BEGIN { split(mean, of, " "); exit !(of[1] <= 0.05) }'
  # The control: the same flakes seen from farther away have less contrast.
  [ "$(/usr/bin/python3 "$code/grain.py" plain-3.f32 flaky-3.f32 ./-1.exr ./+1.exr | awk '{ print $1 }' | head -2 | paste -sd' ' | awk '{ print $1 < 0.5 * $2 }')" -eq 1 ]
}

# Tilted normals stand for a brushed surface, in the page as in the engine.
@test "brushed paints look as render-osmesa draws them, under the lamp too" {
  needs_browser
  paint-edit -q "$TESTDATA/paints.paints.xml#candy_red" --anisotropy 0.12,0.3 --suffix _brushed -o brushed.paints.xml
  fit-paint -q -b "$TESTDATA/b5.basis.xml" brushed.paints.xml -o brushed.fitted.xml
  paint-studio -q --mesh "$TESTDATA/speed-shape.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" \
    "$TESTDATA/paints.paints.xml#silver_fine" brushed.paints.xml -o brushed.html
  figures pictures brushed.html . 640x360 candy_red_brushed
  [ "$(jq '.layers | map(.p95 <= 4.9e-4) == [true]' pictures.json)" = true ]
  white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' brushed.html | jq '.environments[0].white')
  half=$(jq -n "$white / 2")
  draw() {
    render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" --paint "$1" --env studio.env.exr --engine gl \
      --effects all,-rays --size 640x360 --samples 1 "${@:3}" -o "$2.exr"
  }
  draw brushed.fitted.xml brushed
  draw brushed.fitted.xml brushed-lamp --light "-25,40,$half,$half,$half@4"
  fit-paint -q -b "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml#candy_red" -o smooth.xml
  draw smooth.xml smooth
  measure() {
    run /usr/bin/python3 "$code/compare.py" "candy_red_brushed-studio$1.f32" "$2.exr" "$white"
    echo "$2: mean p95 largest pixels: $output"
  }
  for what in "" -lamp; do
    measure "$what" "brushed$what"
    awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.1 && n[2] <= 0.5 && n[4] > 20000) }'
  done
  # The control: the same paint without brushing is another picture.
  measure "" smooth
  awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[2] > 2) }'
}

# The lamp beside the environment; and the environment turned by a right angle, which is the mesh and the camera turned the
# other way.
@test "the lamp and the turned light are those of render-osmesa" {
  needs_browser
  [ -s candy_red-studio-lamp.f32 ] || skip "the pictures were not drawn"
  awk '/^vn? / { printf "%s %s %s %s\n", $1, -$4, $3, $2; next } { print }' "$TESTDATA/speed-shape.obj" >turned.obj
  for light in studio outdoor; do
    white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' page.html |
      jq ".environments[] | select(.name == \"$light\").white")
    half=$(jq -n "$white / 2")
    render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" --paint "fitted.xml#candy_red" --env "$light.env.exr" --engine gl \
      --light "-25,40,$half,$half,$half@4" --effects all,-rays --size 640x360 --samples 1 -o "lamp-$light.exr"
    render-osmesa -q --trim --mesh turned.obj --paint "fitted.xml#candy_red" --env "$light.env.exr" --engine gl \
      --camera -55,12 --effects all,-rays --size 640x360 --samples 1 -o "turned-$light.exr"
    for what in lamp turned; do
      run /usr/bin/python3 "$code/compare.py" "candy_red-$light-$what.f32" "$what-$light.exr" "$white"
      echo "$what $light: mean p95 largest pixels: $output"
      awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.1 && n[2] <= 0.5 && n[4] > 20000) }'
    done
  done
}

@test "the picture answers to mouse, finger and keyboard" {
  needs_browser
  run node "$code/surface.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
}

@test "the gamut of a print stands beside that of the screen, and losses in print are told" {
  needs_browser
  python3 "$code/print_profile.py" printer.icc
  pack() { paint-studio -q --mesh "$TESTDATA/speed-shape.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o print.html "$@"; }
  pack --print-profile printer.icc
  run node "$code/print.js" print.html .
  echo "$output"
  [ "$status" -eq 0 ]
  head -c 1000 printer.icc >cut.icc
  for file in cut.icc page.html; do
    run pack --print-profile "$file"
    [ "$status" -eq 3 ]
    [[ "$output" == "paint-studio: $file: "*"profile of a printer"* ]]
  done
}

@test "a paint is designed and saved by the keyboard alone" {
  needs_browser
  run node "$code/keys.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
}

@test "the stage, the picture and the design stay" {
  needs_browser
  run node "$code/stay.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
}

@test "colors beside the picture are those of the picture, on a screen of Display P3 too" {
  needs_browser
  run node "$code/wide.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
}

@test "two tabs and a copy of one keep their sessions" {
  needs_browser
  run node "$code/tabs.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
}

@test "Firefox shows the picture that Chromium shows" {
  command -v firefox >/dev/null && command -v xvfb-run >/dev/null || skip "Firefox or xvfb-run is not installed"
  [ -s candy_red-studio.f32 ] || skip "the pictures were not drawn"
  run timeout 200 xvfb-run -a node --experimental-websocket "$code/firefox.js" page.html candy_red candy_red-studio.f32 640x360
  echo "$output"
  [ "$status" -eq 0 ]
  # The control: another paint is another picture.
  run timeout 200 xvfb-run -a node --experimental-websocket "$code/firefox.js" page.html candy_red silver_black_flop-studio.f32 640x360
  [ "$status" -eq 1 ]
}

# The rules are those of the npm package axe-core, where it is installed.
@test "axe finds nothing that shuts anybody out" {
  needs_browser
  npm=$BATS_TEST_DIRNAME/../../build/paint-studio-checks-npm
  command -v npm >/dev/null || skip "npm is not there"
  [ -d "$npm/node_modules/axe-core" ] || { mkdir -p "$npm" && (cd "$npm" && timeout 120 npm install --silent axe-core@4.14.1) >/dev/null 2>&1; } ||
    skip "npm cannot install the package axe-core"
  run node "$code/axe.js" page.html . "$npm/node_modules/axe-core/axe.min.js"
  echo "$output"
  [ "$status" -eq 0 ]
}

# The control of the readings: another paint's are not the same.
@test "files of every kind are opened as the tools read them" {
  needs_browser
  python3 - <<'PY'
import math, struct, zipfile
rows = ["Name|Geometry|L*|a*|b*", "rot|45as15|41.5|-1.25|3", "rot|45as45|30|-1|2", "rot|45as110|22|-1|1"]
cells = "".join('<row r="%d">%s</row>' % (r + 1, "".join('<c r="%s%d" t="inlineStr"><is><t>%s</t></is></c>' % (chr(65 + c), r + 1, text) for c, text in enumerate(row.split("|")))) for r, row in enumerate(rows))
main, office = "http://schemas.openxmlformats.org/spreadsheetml/2006/main", "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
with zipfile.ZipFile("book.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
    archive.writestr("xl/workbook.xml", '<workbook xmlns="%s" xmlns:r="%s"><sheets><sheet name="D65/10" sheetId="1" r:id="rId1"/></sheets></workbook>' % (main, office))
    archive.writestr("xl/_rels/workbook.xml.rels", '<Relationships><Relationship Id="rId1" Target="worksheets/sheet1.xml"/></Relationships>')
    archive.writestr("xl/worksheets/sheet1.xml", '<worksheet xmlns="%s"><sheetData>%s</sheetData></worksheet>' % (main, cells))
def rgbe(r, g, b):
    exponent = math.frexp(max(r, g, b))[1]
    return bytes(int(x * 2.0 ** (8 - exponent)) for x in (r, g, b)) + bytes([exponent + 128])
with open("probe.hdr", "wb") as file:
    file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 128\n")
    for y in range(64):
        for x in range(128):
            lit = 12 if abs(x - 40) < 6 and abs(y - 20) < 6 else 0.2 + 0.3 * (y < 30)
            file.write(rgbe(lit, lit * (0.8 + 0.2 * x / 128), lit * 0.9))
PY
  # OpenEXR holds this light in each packing, as halves of a crop, and in tiles and packings that a page refuses.
  for packing in none rle zips zip piz dwaa; do oiiotool probe.hdr -d float --compression $packing -o "probe-$packing.exr"; done
  oiiotool probe.hdr -d half --compression zip -o probe-half.exr
  oiiotool probe.hdr --cut 60x40+20+10 --fullsize 128x64+0+0 -d half --compression rle -o probe-crop.exr
  oiiotool probe-crop.exr --croptofull -d float --compression none -o probe-full.exr
  exrmaketiled probe-zip.exr probe-tiles.exr
  cat >instrument.qtx <<'QTX'
[STANDARD_DATA 0]
STD_NAME=gray
STD_REFLPOINTS=31
STD_REFLINTERVAL=10
STD_REFLLOW=400
STD_VIEWING=45as45
QTX
  echo "STD_R=$(python3 -c 'print(",".join(str(20 + i / 10) for i in range(31)))')" >>instrument.qtx
  paint-convert -q "$TESTDATA/paints.paints.xml#candy_red,silver_fine" --to cxf -o two.cxf
  paint-convert -q "$TESTDATA/paints.paints.xml#candy_red,silver_fine" --to cgats -o two.txt
  files=("$TESTDATA/paints.csv" book.xlsx two.cxf two.txt instrument.qtx "$TESTDATA/paints-wide.csv" "$TESTDATA/paints.paints.xml")
  prefilter-envmap -q probe.hdr --basis "$TESTDATA/b5.basis.xml" -o probe.env.exr
  paint-studio -q --mesh "$TESTDATA/doors.glb" --env studio.env.exr --env probe.env.exr --basis "$TESTDATA/b5.basis.xml" \
    "$TESTDATA/paints.paints.xml" -o open.html
  run node "$code/open.js" open.html . "${files[@]}"
  echo "$output"
  [ "$status" -eq 0 ]
  for file in "${files[@]}"; do
    paint-convert -q "$file" --to csv -o theirs.csv
    same_readings <(cut -d, -f1-7 theirs.csv) <(head -"$(wc -l <theirs.csv)" "$(basename "$file").opened.csv" | cut -d, -f1-7)
  done
  paint-convert -q book.xlsx --to csv -o theirs.csv
  run same_readings theirs.csv instrument.qtx.opened.csv
  [ "$status" -ne 0 ]
  for file in wrong.paints.xml between.paints.xml wrong.csv; do
    run paint-convert "$file" --to csv -o none.csv
    [ "$status" -eq 3 ]
    [[ "$output" == *"$(jq -r ".[\"$file\"]" told.json)"* ]]
  done
}

@test "the page speaks two languages, and gives away a card and a film" {
  needs_browser
  run node "$code/share.js" page.html . "$code/../page/page.html"
  echo "$output"
  [ "$status" -eq 0 ]
}

# Nothing but the file itself: no file of the tools, no network.
@test "the page of --empty is the whole studio" {
  needs_browser
  paint-studio --empty -o empty.html --report empty.json
  [ "$(jq .results.bytes empty.json)" -le 12000000 ]
  [ "$(jq .results.code_bytes empty.json)" -le 4000000 ]
  run node "$code/empty.js" empty.html .
  echo "$output"
  [ "$status" -eq 0 ]
  grep -q '^# .*Save paint XML' empty-command.txt
  sh -eu empty-command.txt
  grep -q '<gloss[^>]*>30<' design.paints.xml
}

@test "droppers take from a picture what paint-pick takes" {
  needs_browser
  run node "$code/droppers.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
  bash -euo pipefail pick-command.txt
  paint-convert -q picked.paints.xml --columns all -o picked.csv
  # The page rounds colors to hundredths and gloss to tenths.
  python3 - taken.json picked.paints.xml <<'PY'
import json, sys
import xml.etree.ElementTree as tree
taken, space = json.load(open(sys.argv[1])), "{urn:goniochrome:paint:1}"
paint = tree.parse(sys.argv[2]).getroot().find(space + "paint")
for end in ("face", "flop"):
    theirs = paint.find(f"{space}appearance/{space}{end}")
    for value, name in zip(taken[end], "Lab"):
        assert abs(value - float(theirs.get(name))) <= 0.0051, (end, name, value, theirs.get(name))
assert abs(taken["gloss"] - float(paint.find(space + "gloss").text)) <= 0.051
PY
}

@test "the library is searched, filtered and seen in L*a*b*" {
  needs_browser
  run node "$code/library.js" page.html .
  echo "$output"
  [ "$status" -eq 0 ]
  # A filter goes through 10^4 paints in 15 ms.
  awk 'BEGIN { srand(5); split("15 25 45 75 110", angles); print "sample,geometry,illuminant,observer,L,a,b"
    for (i = 0; i < 10000; ++i) { L = 20 + 80 * rand(); a = 120 * rand() - 60; b = 120 * rand() - 60
      for (g = 1; g <= 5; ++g) { share = 40 / (25 + angles[g]); printf "p%05d,45as%d,D65,10,%.2f,%.2f,%.2f\n", i, angles[g], share * L, share * a, share * b } } }' >many.csv
  paint-studio -q --mesh "$TESTDATA/box.obj" --env studio.env.exr --basis "$TESTDATA/b5.basis.xml" many.csv -o many.html
  run node "$code/library.js" many.html .
  echo "$output"
  [ "$status" -eq 0 ]
  [ "$(grep '^{' <<<"$output" | jq '.count == 10000 and .filter_ms <= 15')" = true ]
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
  same_readings theirs.csv ours.csv
  cp "$TESTDATA/paints.paints.xml" library.paints.xml  # an index is written beside it
  colorsnap -q --library library.paints.xml saved.paints.xml >/dev/null || [ $? -eq 1 ]
  grep -q '^sample,geometry,illuminant' saved.csv
  # The tools' picture of the paint that was saved is that of the page.
  white=$(sed -n 's|^<script type="application/json" id="data">\(.*\)</script>$|\1|p' page.html | jq '.environments[0].white')
  render-osmesa -q --trim --mesh "$TESTDATA/speed-shape.obj" --paint by-tools.xml --env studio.env.exr --engine gl \
    --effects all,-rays --size 640x360 --samples 1 -o path.exr
  run /usr/bin/python3 "$code/compare.py" path.f32 path.exr "$white"
  echo "mean p95 largest pixels: $output"
  awk -v numbers="$output" 'BEGIN { split(numbers, n, " "); exit !(n[1] <= 0.1 && n[2] <= 0.5 && n[4] > 20000) }'
}
