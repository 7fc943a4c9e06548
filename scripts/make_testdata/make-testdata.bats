#!/usr/bin/env bats
# scripts/make-testdata: the files of testdata/ can be made again.

# described FILE: the header of a picture, without its name.
described() { oiiotool --info -v "$1" | sed 1,2d; }

@test "every file is made again, byte for byte, or an EXR as another library packs it" {
  "$BATS_TEST_DIRNAME/../make-testdata" --out "$BATS_TEST_TMPDIR/made"
  while read -r made; do
    local new="$BATS_TEST_TMPDIR/made/$made" kept="$TESTDATA/$made"
    if [[ $made != *.exr ]]; then
      cmp "$new" "$kept"
    elif ! cmp -s "$new" "$kept"; then
      oiiotool "$new" "$kept" --fail 0 --diff
      diff <(described "$new") <(described "$kept")
    fi
  done < <(cd "$BATS_TEST_TMPDIR/made" && find . -type f)
  [ "$(ls "$BATS_TEST_TMPDIR/made/capture")" = "$(ls "$TESTDATA/capture")" ]
  # Only what PROVENANCE.md says is not among them, and indices that colorsnap keeps beside libraries.
  [ "$(ls "$TESTDATA" | grep -v '\.snapindex$' | grep -vxF "$(ls "$BATS_TEST_TMPDIR/made")" | xargs)" = 'PROVENANCE.md contact-sheet.jpg published-lights.csv published-reflectances.csv' ]
}

@test "a folder that cannot be written is named" {
  run "$BATS_TEST_DIRNAME/../make-testdata" --out /dev/null/none --only b5.basis.xml
  [ "$status" -eq 3 ]
  [[ $output == *'make-testdata: /dev/null'* ]]
}

@test "surfaces are made with more texels" {
  "$BATS_TEST_DIRNAME/../make-testdata" --out "$BATS_TEST_TMPDIR/large" --only wood.sbrdf.exr --size 256
  run oiiotool --info "$BATS_TEST_TMPDIR/large/wood.sbrdf.exr"
  [[ $output == *"256 x  256, 12 channel"* ]]
  run "$BATS_TEST_DIRNAME/../make-testdata" --out "$BATS_TEST_TMPDIR/large" --only wood.sbrdf.exr --size 100
  [ "$status" -eq 2 ]
  [[ $output == *"--size 100 is not a multiple of 128"* ]]
}
