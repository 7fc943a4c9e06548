# prefilter-envmap from the outside: options, streams, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  basis=$TESTDATA/b5.basis.xml
  sky=$TESTDATA/outdoor.exr
}

# values KEY: every value of that key in the report, one a line.
values() { grep "\"$1\"" r.json | sed -E 's/.*: "?([^",]+)"?,?$/\1/'; }

# within LIMIT: every number of standard input is at most that, and there are some.
within() { awk -v limit="$1" '$1 > limit { bad = 1 } { n++ } END { exit bad || !n }'; }

@test "a sky is filtered by a basis, and the verified error is within the tolerance" {
  run --separate-stderr prefilter-envmap --basis "$basis" --size 16 --verify 10 "$sky" -o sky.env.exr --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ ^"prefilter-envmap: "[0-9]+" lobes in "[0-9.]+" s; largest error "[0-9.e-]+" of 12 texels a lobe, tolerance 0.001"$ ]]
  values max_rel_error | within 1e-3
  values energy_ratio | head -1 | awk '{ if ($1 < .999 || $1 > 1.001) exit 1 }'
}

@test "the file has its parts and attributes" {
  command -v exrheader >/dev/null || skip "no exrheader"
  prefilter-envmap -q -e 6,70 --size 8 --verify 4 "$sky" -o sky.env.exr
  exrheader sky.env.exr >header
  for name in diffuse lobe-000 lobe-001 mirror; do grep -q "\"$name\"" header; done
  [ "$(grep -c 'goniochrome:texels.*"center"' header)" -eq 4 ]
  [ "$(grep -c 'colorInteropID.*"lin_rec2020_scene"' header)" -eq 4 ]
  grep -q 'goniochrome:exponent (type float): 70' header
  grep -q 'goniochrome:maxError' header
  grep -q 'goniochrome:command.*prefilter-envmap [0-9.]*: prefilter-envmap -q -e 6,70' header
  grep -q "goniochrome:source.*outdoor.exr" header
}

@test "standard input to standard output" {
  prefilter-envmap -q -e 20 --size 8 <"$sky" >a.env.exr
  prefilter-envmap -q -e 20 --size 8 - -o - <"$sky" >b.env.exr
  [ -s a.env.exr ]
  [ "$(wc -c <a.env.exr)" -gt 1000 ]
}

@test "the bits do not depend on the threads" {
  for threads in 1 2 7; do
    prefilter-envmap -q -e 1.3,20,900 --size 8 --threads "$threads" "$sky" -o out.env.exr
    # The command line in the file differs by one digit.
    LC_ALL=C sed 's/--threads [0-9]/--threads N/g' out.env.exr | cksum >>sums
  done
  [ "$(sort -u sums | wc -l)" -eq 1 ]
}

@test "an exponent named twice and exponent 1 are filtered once" {
  prefilter-envmap -q -e 6,1,6 --size 8 --no-mirror --report r.json "$sky" -o out.env.exr
  [ "$(values exponent | tr '\n' ' ')" = "1.0 6.0 " ]
}

@test "the plan comes before the work" {
  run --separate-stderr prefilter-envmap -e 0.3,6,1e5 --size 4 --explain "$sky" -o out.env.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "1024 x 512 texels, each a constant patch" ]]
  [[ "$stderr" =~ 0.3\ +4\ +blocks ]]
  [[ "$stderr" =~ 6\ +4\ +harmonics ]]
  [[ "$stderr" =~ 1e\+05\ +4\ +blocks ]]
}

@test "usage errors" {
  run prefilter-envmap "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "give either --basis FILE or --exponents LIST" ]]
  run prefilter-envmap -b "$basis" -e 6 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6,-1 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 --size big "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ '--size is "big": give auto' ]]
  run prefilter-envmap -e 6 --tolerance 1e-9 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 "$sky" "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "2 files were given: a cube takes six" ]]
  [ ! -e x.env.exr ]
}

@test "bad input" {
  run prefilter-envmap -e 6 absent.exr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "prefilter-envmap: absent.exr: cannot be read: No such file" ]]
  head -c 20000 "$sky" >cut.exr
  run prefilter-envmap -e 6 cut.exr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "cut.exr: " ]]
  run prefilter-envmap -b absent.xml "$sky" -o x.env.exr
  [ "$status" -eq 3 ]
  run prefilter-envmap -e 6 "$sky" -o absent/x.env.exr
  [ "$status" -eq 3 ]
  [ ! -e x.env.exr ]
}

@test "a missing module for other formats is told with its remedy" {
  printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n12341234' >tiny.hdr
  GONIOCHROME_MODULE_PATH=/nowhere run prefilter-envmap -e 6 tiny.hdr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "/nowhere/goniochrome-oiio.so: cannot be loaded" ]]
  [[ "$output" =~ "GONIOCHROME_MODULE_PATH" ]]
  run prefilter-envmap -q -e 6 --size 4 tiny.hdr -o x.env.exr
  [ "$status" -eq 0 ]
  [ -s x.env.exr ]
}

@test "a killed run leaves the old file" {
  echo old >out.env.exr
  timeout -s KILL 0.3 prefilter-envmap -q -e 0.3 --size 512 "$sky" -o out.env.exr || true
  [ "$(cat out.env.exr)" = old ]
  [ "$(ls -A | wc -l)" -eq 1 ]
}
