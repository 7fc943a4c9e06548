#!/usr/bin/env bats
# The Makefile of the CI recipes: a sound library passes every gate, and each gate stops what it is there to stop.

check() {
  make -s -f "$BATS_TEST_DIRNAME/recipes/Makefile" DATA="$BATS_FILE_TMPDIR/data" LIBRARY=library.paints.xml \
    COMPARE="$BATS_TEST_DIRNAME/recipes/picture-difference" PICTURES="signal_white jet_black" "$@"
}

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mkdir data
  ln -s "$TESTDATA" data/testdata
  cp "$TESTDATA/../lib/formats/paint.xsd" data
  paint-stats -q -f paints -w 'class==solid' "$TESTDATA/paints.paints.xml" >library.paints.xml
  check references
}

setup() {
  cd "$BATS_FILE_TMPDIR"
}

@test "a sound library passes every gate" {
  run check check
  echo "$output"
  [ "$status" -eq 0 ]
  [[ $output == *'signal_white.png: dE00 95 % 0.000'* ]]
}

@test "each threshold stops it" {
  for gate in 'gamut GAMUT_DE00=-1' 'fit FIT_DE00=-1' 'goniogeom GONIOGEOM_DEG=30'; do
    run check $gate
    echo "$gate: $output"
    [ "$status" -eq 2 ]
  done
}

@test "a bad file does not pass the schema" {
  sed 's/L="/L="x/' library.paints.xml >bad.paints.xml
  run check schema LIBRARY=bad.paints.xml
  [ "$status" -eq 2 ]
}

@test "the difference of two pictures: what is refused, and why" {
  difference=$BATS_TEST_DIRNAME/recipes/picture-difference
  run "$difference" references/signal_white.png references/jet_black.png
  [ "$status" -eq 2 ]
  [[ $output == *'picture-difference REFERENCE PICTURE LIMIT'* ]]
  run "$difference" references/signal_white.png references/jet_black.png small
  [ "$status" -eq 3 ]
  run "$difference" references/signal_white.png library.paints.xml 1
  [ "$status" -eq 3 ]
  [[ $output == *library.paints.xml* ]]
  oiiotool references/signal_white.png --resize 160x96 -o smaller.png
  run "$difference" references/signal_white.png smaller.png 1
  [ "$status" -eq 3 ]
  [[ $output == *'smaller.png: is 160x96, the reference 320x192'* ]]
}

@test "a picture that changed is seen" {
  cp references/signal_white.png kept.png
  cp references/jet_black.png references/signal_white.png
  run check pictures
  cp kept.png references/signal_white.png
  [ "$status" -eq 2 ]
}

@test "the color difference meets published pairs" {
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$BATS_TEST_DIRNAME/.. /usr/bin/python3 - <<'PY'
from shared.colors import de2000
# Sharma, Wu, Dalal 2005, table 1, to its four decimals.
for one, two, wanted in [((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425), ((50, 2.5, 0), (50, 0, -2.5), 4.3065),
                         ((50, 2.49, -0.001), (50, -2.49, 0.0011), 7.2195), ((50, 2.5, 0), (73, 25, -18), 27.1492),
                         ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082), ((50, 0, 0), (50, -1, 2), 2.3669)]:
    assert abs(de2000(one, two) - wanted) < 1e-4, (one, two, de2000(one, two))
PY
}
