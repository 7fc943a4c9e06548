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

@test "a mesh, an environment and a basis are needed" {
  run paint-studio --env small.env.exr --basis small.basis.xml hostile.paints.xml
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--mesh FILE is missing" ]]
  run paint-studio --mesh "$mesh" --basis small.basis.xml hostile.paints.xml
  [ "$status" -eq 2 ]
  run paint-studio --mesh "$mesh" --env small.env.exr hostile.paints.xml
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
  ! grep -oE '(src|href)="[^"]*"' page.html
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
  ! grep -q 'onerror=alert(1)>' page.html || ! grep -q '<img' page.html
  ! grep -q '<title><script>' page.html
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
  [[ "$output" =~ "left out: shadows" ]]
}
