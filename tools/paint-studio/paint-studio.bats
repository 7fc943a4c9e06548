# paint-studio from the outside: what the page holds, what stands in it as text, errors and exit statuses.

bats_require_minimum_version 1.5.0

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  prefilter-envmap -q "$TESTDATA/studio.exr" --exponents 1.3,20 --size 16 -o small.env.exr
  cat >small.basis.xml <<'XML'
<basis xmlns="urn:goniochrome:basis:1" name="small"><exponent>1.3</exponent><exponent>20</exponent></basis>
XML
  cat >hostile.paints.xml <<'XML'
<paints xmlns="urn:goniochrome:paint:1" version="1">
  <paint name="&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;" code="&quot;&gt;&lt;b&gt;">
    <appearance travel="60"><face L="60" a="5" b="-20"/><flop L="20" a="3" b="-30"/></appearance>
    <colorMap href="absent.exr" index="1.5"/>
  </paint>
</paints>
XML
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  mesh=$TESTDATA/box.obj
}

needs_page() {
  [ -f "$(dirname "$(command -v paint-studio)")/../lib/goniochrome/studio.wasm" ] ||
    skip "there was no compiler for WebAssembly when the tools were built"
}

make_page() { paint-studio --mesh "$mesh" --env small.env.exr --basis small.basis.xml "$@"; }

@test "without the compiled library the tool names the packages that it takes" {
  GONIOCHROME_MODULE_PATH=/nonexistent run make_page hostile.paints.xml -o page.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ "/nonexistent/studio.html: is missing" ]]
  [[ "$output" =~ "libc++-19-dev-wasm32" ]]
  [ ! -e page.html ]
}

@test "a mesh and an environment are needed" {
  run paint-studio --env small.env.exr --basis small.basis.xml hostile.paints.xml
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--mesh FILE is missing" ]]
  run paint-studio --mesh "$mesh" --basis small.basis.xml hostile.paints.xml
  [ "$status" -eq 2 ]
}

@test "the page is one file without addresses, and its policy allows its own script alone" {
  needs_page
  run --separate-stderr make_page --env small.env.exr "$TESTDATA/paints.paints.xml" -o page.html --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ "2 environments, " ]]
  [ "$(jq .results.bytes r.json)" -eq "$(stat -c %s page.html)" ]
  [ "$(jq .results.code_bytes r.json)" -le 3000000 ]
  [ "$(jq '.results.environments | length' r.json)" -eq 2 ]
  [ "$(jq .results.triangles r.json)" -gt 0 ]
  policy=$(grep -o "Content-Security-Policy\" content=\"[^\"]*" page.html)
  [[ "$policy" =~ "default-src 'none'" ]]
  [[ ! "$policy" =~ unsafe-inline ]]
  [[ ! "$policy" =~ "'unsafe-eval'" ]]
  ! grep -oE '(src|href)="[^"]*"' page.html || false
  # The hashes in the policy are those of the script and the style.
  for tag in script style; do
    hash=$(awk "/^<$tag>/ { inside = 1; sub(/^<$tag>/, \"\") } inside { if (/<\\/$tag>/) { sub(/<\\/$tag>.*/, \"\"); printf \"%s\", \$0; exit } print }" page.html |
      python3 -c 'import base64, hashlib, sys
print(base64.b64encode(hashlib.sha256(sys.stdin.buffer.read()).digest()).decode())')
    [[ "$policy" =~ "sha256-$hash" ]]
  done
}

@test "two runs make the same page, and standard output gets it too" {
  needs_page
  make_page -q hostile.paints.xml -o page.html
  make_page -q --threads 1 hostile.paints.xml -o again.html
  cmp <(sed 's/"command":"[^"]*"//' page.html) <(sed 's/"command":"[^"]*"//' again.html)
  make_page -q <hostile.paints.xml >stream.html
  [ "$(wc -l <stream.html)" -eq "$(wc -l <page.html)" ]
}

@test "names of paints are text and never markup" {
  needs_page
  run make_page hostile.paints.xml --title '<script>' -o page.html
  [ "$status" -eq 0 ]
  [[ "$output" =~ "1 paints have a color map, which the page does not draw" ]]
  ! grep -q 'onerror=alert(1)>' page.html || ! grep -q '<img' page.html || false
  ! grep -q '<title><script>' page.html || false
  [ "$(grep -o '</script>' page.html | wc -l)" -eq 6 ]
  # The paints are JSON, and hold the name as it is.
  sed -n 's|^<script type="application/json" id="paints">\(.*\)</script>$|\1|p' page.html >paint.json
  [ "$(jq -r '.paint.name' paint.json)" = '</script><img src=x onerror=alert(1)>' ]
}

@test "an environment without a lobe of the basis, a paint without color and a missing file are errors" {
  needs_page
  run paint-studio --mesh "$mesh" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" hostile.paints.xml -o page2.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ "small.env.exr: the environment has no lobe of exponent" ]]
  [[ "$output" =~ "prefilter-envmap" ]]
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="x"/></paints>' >bare.xml
  run make_page bare.xml -o page2.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ "the paint \"x\" has neither readings nor a face and a flop" ]]
  run paint-studio --mesh absent.obj --env small.env.exr --basis small.basis.xml hostile.paints.xml -o page2.html
  [ "$status" -eq 3 ]
  [ ! -e page2.html ]
}

@test "--explain tells what is packed and what is left out" {
  needs_page
  run make_page --explain hostile.paints.xml -o page.html
  [ "$status" -eq 0 ]
  [[ "$output" =~ "approximate: light from one part to another" ]]
}

@test "a traced view of another mesh or basis, a cut one and one without light are refused" {
  needs_page
  cat >grown.obj <<OBJ
$(awk '$1 == "v" { print "v", 1.2 * $2, $3, $4; next } { print }' "$mesh")
OBJ
  fit-paint -q --basis small.basis.xml "$TESTDATA/paints.paints.xml#silver_fine" -o worn.xml
  view=(--size 48x32 --samples 1 --env small.env.exr -p worn.xml --tolerance 20)
  render-osmesa -q --mesh "$mesh" "${view[@]}" --aov transport -o view.exr
  run make_page "$TESTDATA/paints.paints.xml" --transport view.exr -o page.html --report r.json --explain
  [ "$status" -eq 0 ]
  [[ "$output" =~ "traced views: view.exr" ]]
  [[ "$output" =~ "rounding changes paints by 0.0" ]]
  [ "$(jq '.results.transports[0].name' r.json)" = '"view"' ]
  [ "$(jq '.results.transports[0].points > 200' r.json)" = true ]
  refused() {
    run paint-studio --mesh "$1" --env small.env.exr --basis "$2" "$TESTDATA/paints.paints.xml" --transport "$3" -o none.html
    [ "$status" -eq 3 ]
    [ "$(grep -c "$3" <<<"$output")" -eq 1 ]
    [ ! -e none.html ]
  }
  refused grown.obj small.basis.xml view.exr
  [[ "$output" =~ "shows another mesh: ".*" points are not on this one" ]]
  refused "$TESTDATA/speed-shape.obj" small.basis.xml view.exr
  [[ "$output" =~ "view.exr: shows another mesh: " ]]
  head -c 9000 view.exr >cut.exr
  refused "$mesh" small.basis.xml cut.exr
  render-osmesa -q --mesh "$mesh" "${view[@]}" --aov normal,part -o bare.exr
  refused "$mesh" small.basis.xml bare.exr
  [[ "$output" =~ "render it with --aov transport" ]]
  # A basis of another lobe, whose environment is there.
  prefilter-envmap -q "$TESTDATA/studio.exr" --exponents 1.3,20,33 --size 16 -o small.env.exr
  sed 's|</basis>|<exponent>33</exponent></basis>|' small.basis.xml >larger.basis.xml
  refused "$mesh" larger.basis.xml view.exr
  [[ "$output" =~ "holds the light of lobes of the exponents 1.3, 20, and the basis small has 1.3, 20, 33" ]]
}
