#!/usr/bin/env bats
# The Makefile of the CI recipes: a sound library passes, and each gate stops what it is there for.

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

@test "a bad file is no schema" {
  sed 's/L="/L="x/' library.paints.xml >bad.paints.xml
  run check schema LIBRARY=bad.paints.xml
  [ "$status" -eq 2 ]
}

@test "a picture that moved is seen" {
  cp references/signal_white.png kept.png
  cp references/jet_black.png references/signal_white.png
  run check pictures
  cp kept.png references/signal_white.png
  [ "$status" -eq 2 ]
}

@test "the color difference meets published pairs" {
  /usr/bin/python3 - "$BATS_TEST_DIRNAME/recipes/picture-difference" <<'PY'
import importlib.machinery, importlib.util, sys
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("difference", sys.argv[1])
module = importlib.util.module_from_spec(importlib.util.spec_from_loader("difference", loader))
loader.exec_module(module)
# Sharma, Wu, Dalal 2005, table 1, to its four decimals.
for one, two, wanted in [((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425), ((50, 2.5, 0), (50, 0, -2.5), 4.3065),
                         ((50, 2.49, -0.001), (50, -2.49, 0.0011), 7.2195), ((50, 2.5, 0), (73, 25, -18), 27.1492),
                         ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082), ((50, 0, 0), (50, -1, 2), 2.3669)]:
    assert abs(module.de2000(one, two) - wanted) < 1e-4, (one, two, module.de2000(one, two))
PY
}
