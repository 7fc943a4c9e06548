# plot-paint from the outside: pages, sheets, formats, exit statuses.

bats_require_minimum_version 1.5.0

setup_file() {
  fit-paint -q -b "$TESTDATA/b7.basis.xml" "$TESTDATA/paints.paints.xml" -o "$BATS_FILE_TMPDIR/fitted.xml"
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  paints=$TESTDATA/paints.paints.xml
  cp "$BATS_FILE_TMPDIR/fitted.xml" .
}

@test "one paint makes a page: curves, lobes, polar diagram, surfaces and squares" {
  run --separate-stderr plot-paint --paint candy_red fitted.xml -o page.svg --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ "plot-paint: 1 paints drawn"$ ]]
  xmllint --noout page.svg
  for title in 'L\*' 'a\*' 'b\*' 'a\*b\* plane, 15 to 110 deg' 'Color over the aspecular angle (deg)' 'Parts of the reflectance factor' 'Reflectance factor, light at 45 deg' \
    'Root of the flake, green' '10 deg, curve' '70 deg, fit'; do
    grep -q ">$title<" page.svg
  done
  ! grep -qE '[" ,](-?nan|-?inf)[" ,]' page.svg || false
  grep -q '"target": "curve"' r.json
}

# A name of three characters is some 22 px wide and 11 px high.
@test "the names of angles in the a*b* plane do not lie on one another" {
  mkdir plane
  plot-paint -q fitted.xml --pages plane
  for page in plane/*.svg; do
    grep 'class="angle"' "$page" | sed 's/.* x="\([^"]*\)" y="\([^"]*\)".*>\(.*\)<.*/\1 \2 \3/' >names.txt || true
    awk -v page="$page" '{ for (i = 1; i < NR; ++i)
        if ((dx = $1 - x[i]) * dx < (3.75 * (length($3) + size[i])) ^ 2 - 1 && (dy = $2 - y[i]) * dy < 120) {
          print page ": " $3 " lies on another name"; bad = 1
        }
      x[NR] = $1; y[NR] = $2; size[NR] = length($3) } END { exit bad }' names.txt
  done
  [ "$(grep -c 'class="angle"' plane/candy_red.svg)" -ge 5 ]
}

@test "several paints make a sheet, and --pages makes a page for each" {
  plot-paint -q --paint candy_red --paint jet_black fitted.xml -o sheet.svg
  xmllint --noout sheet.svg
  [ "$(grep -c '>L\*<' sheet.svg)" -eq 2 ]
  mkdir pages
  plot-paint -q --paint candy_red --paint jet_black --pages pages fitted.xml
  [ "$(ls pages)" = "$(printf 'candy_red.svg\njet_black.svg')" ]
  run plot-paint --pages absent fitted.xml
  [ "$status" -eq 3 ]
  [[ "$output" =~ "absent: is no folder" ]]
}

@test "words in braces make a page for each paint, safe and told apart" {
  plot-paint -q --paint candy_red --paint jet_black fitted.xml -o '{index} x-{name}.svg' --report r.json
  [ "$(ls ./*.svg)" = "$(printf './0001 x-jet_black.svg\n./0002 x-candy_red.svg')" ]
  grep -q '>candy_red, ' '0002 x-candy_red.svg'
  grep -q '"file": "0001 x-jet_black.svg"' r.json
  sed -e 's/name="candy_red"/name="a\/b"/' -e 's/name="jet_black"/name="a_b"/' fitted.xml >alike.xml
  mkdir 'pages {x}'
  plot-paint -q --paint a/b --paint a_b alike.xml --pages 'pages {x}'
  [ "$(ls 'pages {x}')" = "$(printf 'a_b-2.svg\na_b.svg')" ]
  run plot-paint fitted.xml -o '{name}-{face}.svg'
  [ "$status" -eq 2 ]
  [[ "$output" =~ "{face} is not known here" ]]
  run plot-paint fitted.xml --pages . -o '{name}.svg'
  [ "$status" -eq 2 ]
  [[ "$output" =~ "exclude each other" ]]
}

@test "a paint without lobes is drawn, and the summary says what makes them" {
  run plot-paint --paint candy_red "$paints" -o page.svg
  [ "$status" -eq 0 ]
  [[ "$output" =~ "1 of them without lobes: fit-paint makes them" ]]
  ! grep -q '10 deg, fit' page.svg || false
}

@test "the heading tells a brushed surface" {
  paint-edit -q "$paints#candy_red" --anisotropy 0.05,0.3 | plot-paint -q -o page.svg
  grep -q '>candy_red, metallic, D65/10 deg, brushed 0.05 x 0.3<' page.svg
}

@test "standard input goes to standard output" {
  run --separate-stderr bash -c "plot-paint -q --paint candy_red <fitted.xml"
  [ "$status" -eq 0 ]
  [[ "$output" =~ "<svg " ]]
}

@test "a PNG is made by the ending or --format, where rsvg-convert is there" {
  mkdir pages
  if command -v rsvg-convert >/dev/null; then
    plot-paint -q --paint candy_red fitted.xml -o page.png
    file page.png | grep -q 'PNG image data, 1080 x'
    plot-paint -q --paint candy_red --format png --pages pages fitted.xml
    file pages/candy_red.png | grep -q 'PNG image data'
  fi
  tool=$(command -v plot-paint)
  PATH=/nowhere run "$tool" --paint candy_red fitted.xml -o no.png
  [ "$status" -eq 3 ]
  [[ "$output" =~ "install librsvg2-bin" ]]
  [ ! -e no.png ]
}

@test "--incidence chooses the squares" {
  plot-paint -q --paint candy_red --incidence 25 fitted.xml -o page.svg
  grep -q '>25 deg, fit<' page.svg
  ! grep -q '>40 deg, fit<' page.svg || false
}

@test "--brdf holds a measured BRDF against its paint" {
  awk 'BEGIN { print "3\n400 550 700"
    for (ti = 0; ti < 1.5; ti += 0.2) for (to = 0; to < 1.5; to += 0.1) for (az = 0; az <= 3.1; az += 0.3)
      print ti, 0, to, az, 0.1, 0.2, 0.05 }' >candy_red.brdf
  plot-paint -q --paint candy_red --brdf candy_red.brdf fitted.xml -o page.svg --report r.json
  grep -q '>40 deg, measured<' page.svg
  grep -q '"target": "measured BRDF"' r.json
  cp candy_red.brdf other.brdf
  run plot-paint --paint candy_red --brdf other.brdf fitted.xml -o page.svg
  [[ "$output" =~ 'no paint is named "other"' ]]
  # Reasons to doubt it were told by fits alone.
  awk 'NR > 2 { for (i = 5; i <= 7; ++i) $i *= 9 } { print }' candy_red.brdf >other.brdf
  run plot-paint --brdf other.brdf fitted.xml -o page.svg
  [[ "$output" == *": warning: other.brdf: reflects "*" of the light at 45 deg: more than there is"* ]]
}

@test "wrong values are refused by name" {
  for wrong in "--format pdf" "--incidence 95" "--incidence x"; do
    # shellcheck disable=SC2086
    run plot-paint $wrong fitted.xml -o page.svg
    [ "$status" -eq 2 ]
    [[ "$output" =~ ${wrong%% *} ]]
  done
  run plot-paint --paint nobody fitted.xml -o page.svg
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'no paint is named "nobody"' ]]
  run plot-paint --brdf absent.brdf fitted.xml -o page.svg
  [ "$status" -eq 3 ]
  run plot-paint absent.xml -o page.svg
  [ "$status" -eq 3 ]
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="bare"/></paints>' >bare.xml
  run plot-paint bare.xml -o page.svg
  [ "$status" -eq 3 ]
  [[ "$output" =~ "nothing to draw" ]]
  [ ! -e page.svg ]
}

@test "--color-map draws maps, with uncovered directions hatched; paints without one are told" {
  rows=
  for light in 20 30 45 60; do
    for aspecular in 15 25 40 60 90; do
      rows+="<lab geometry=\"${light}as$aspecular\" L=\"$((90 - aspecular / 2))\" a=\"$((light - 40))\" b=\"5\"/>"
    done
  done
  {
    echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'
    echo "<paint name=\"sea\"><measurement illuminant=\"D65\" observer=\"10\">$rows</measurement></paint>"
    echo '<paint name="plain"><measurement illuminant="D65" observer="10"><lab geometry="45as45" L="50" a="0" b="0"/></measurement></paint>'
    echo '</paints>'
  } >in.xml
  fit-paint -q -b "$TESTDATA/b7.basis.xml" in.xml -o out.xml --color-map maps
  run --separate-stderr plot-paint --color-map out.xml -o map.svg --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'paint "plain" has no color map'* ]]
  grep -q 'sea, color map' map.svg
  grep -q 'of all pairs of directions are covered' map.svg
  # Each hatching is one path of a stroke for each cell.
  [ "$(grep -o 'M[0-9.]* [0-9.]*l' map.svg | wc -l)" -gt 500 ]
  grep -Eq '"model": "(isolines|aspecular)"' r.json
  mkdir pages
  plot-paint -q --color-map -p sea out.xml --pages pages
  [ -s pages/sea.svg ]
  run --separate-stderr plot-paint --color-map -p plain out.xml -o map.svg
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"none of the paints has a color map"* ]]
  rm maps/sea.exr
  run --separate-stderr plot-paint --color-map -p sea out.xml -o map.svg
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"sea.exr"* ]]
}

@test "--hud draws the rings of a paint where their angles are in a view" {
  render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --light 30,50 --size 480x300 --samples 1 --effects auto,-rays --aov aspecular -o view.exr
  run --separate-stderr plot-paint --paint candy_red --hud view.exr "$paints" -o hud.svg
  [ "$status" -eq 0 ]
  xmllint --noout hud.svg
  grep -q '>15 deg, face<' hud.svg
  grep -q '>45 deg<' hud.svg
  grep -q 'deg, travel' hud.svg
  /usr/bin/python3 "$BATS_TEST_DIRNAME/hud_test.py" view.exr hud.svg
  plot-paint -q --hud view.exr --paint candy_red --paint jet_black "$paints" --pages . --format png
  file candy_red.png jet_black.png | grep -c '480 x 392' | grep -qx 2
  run plot-paint --hud view.exr --color-map --paint candy_red "$paints" -o x.svg
  [ "$status" -eq 2 ]
  render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --light 30,50 --size 32x20 --samples 1 --effects auto,-rays -o bare.exr
  run plot-paint --hud bare.exr --paint candy_red "$paints" -o x.svg
  [ "$status" -eq 3 ]
  [[ "$output" =~ "aspecular" ]]
  oiiotool --pattern constant:color=0,0,0,0,180 8x8 5 --chnames R,G,B,A,aspecular -o empty.exr
  run plot-paint --hud empty.exr --paint candy_red "$paints" -o x.svg
  [ "$status" -eq 3 ]
  [[ "$output" =~ "nothing of a mesh is seen in it" ]]
}

@test "--hud draws each ring of a ball as one closed line" {
  /usr/bin/python3 "$BATS_TEST_DIRNAME/hud_test.py" --ball >ball.obj
  render-osmesa -q --mesh ball.obj --light 30,50 --size 480x300 --samples 1 --effects auto,-rays --aov aspecular -o ball.exr
  plot-paint -q --paint candy_red --hud ball.exr "$paints" -o ball.svg
  /usr/bin/python3 "$BATS_TEST_DIRNAME/hud_test.py" ball.exr ball.svg --closed
}

@test "the contrast of grain is drawn against distance" {
  run plot-paint --sparkle --paint candy_red --paint jet_black fitted.xml --report r.json -o grain.svg
  [ "$status" -eq 0 ]
  [[ "$output" =~ "paint \"jet_black\" has no flakes: paint-edit --flakes states them" ]]
  grep -q "flakes of 30 um, coverage 0.5, spread 0.5 deg (assumed for class metallic)" grain.svg
  grep -q "none under an even sky" grain.svg
  # Six plates, of which no two are the same: the grain of each distance, also under the cloud.
  [ "$(grep -c '<image' grain.svg)" -eq 6 ]
  [ "$(grep -o 'base64,[^"]*' grain.svg | sort -u | wc -l)" -eq 6 ]
  for plate in "sun, 0.3 m" "sun, 3 m" "cloud, 1 m"; do grep -q "$plate" grain.svg; done
  ! grep -q "instrument" grain.svg || false
  sed '/<paint name="candy_red"/,/<\/paint>/s|</measurement>|<texture quantity="Sparkle Grade" geometry="15d" value="3.25"/></measurement>|' fitted.xml >told.xml
  plot-paint -q --sparkle --paint candy_red told.xml -o told.svg
  grep -q "instrument, on its own scale: Sparkle Grade 15d 3.25" told.svg
  jq -e '.results.paints[0] | .name == "candy_red" and .flakes_assumed' r.json
  run plot-paint --sparkle --paint candy_red "$paints" -o grain.svg
  [ "$status" -eq 3 ]
  [[ "$output" =~ "has no lobes: fit-paint makes them" ]]
  run plot-paint --sparkle --color-map fitted.xml -o grain.svg
  [ "$status" -eq 2 ]
}
