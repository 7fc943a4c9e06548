# fit-basis from the outside: options, streams, exit statuses.

setup() { cd "$BATS_TEST_TMPDIR"; }

quick=(--lobes 2 --starts 1)

@test "a basis comes out, ascending, and fit-paint takes it" {
  run fit-basis "${quick[@]}" "$TESTDATA/paints.paints.xml" -o b.basis.xml
  [ "$status" -eq 0 ]
  grep -q '<basis [^>]*name="b2"' b.basis.xml
  [ "$(grep -c '<exponent>' b.basis.xml)" -eq 2 ]
  grep -q '<mirror/>' b.basis.xml
  fit-paint --basis b.basis.xml "$TESTDATA/paints.paints.xml" -o fitted.paints.xml
}

@test "a range writes every set, the table and the plot" {
  run fit-basis --lobes 1..3 --starts 1 --each set- --table sets.csv --plot sets.svg --report r.json \
    "$TESTDATA/paints.paints.xml" -o b.basis.xml
  [ "$status" -eq 0 ]
  [ -e set-1.basis.xml ]
  [ -e set-2.basis.xml ]
  [ -e set-3.basis.xml ]
  [ "$(wc -l <sets.csv)" -eq 4 ]
  # Three lobes of the sample library are all but regular in log space.
  awk -F, 'NR == 1 { exit !($5 == "log_regularity") } ' sets.csv
  awk -F, 'END { exit !($5 > 0.9 && $5 <= 1) }' sets.csv
  xmllint --noout sets.svg
  jq -e '.results.sets | length == 3 and (.[0].objective >= .[1].objective) and (.[1].objective >= .[2].objective)' r.json
}

@test "reads a stream and writes a stream" {
  run bash -c "fit-basis ${quick[*]} --quiet - <'$TESTDATA/paints.paints.xml' | xmllint --noout -"
  [ "$status" -eq 0 ]
}

@test "the same seed gives the same basis for any number of threads" {
  for threads in 1 2 7; do
    fit-basis --lobes 2 --starts 4 --seed 9 --threads $threads --quiet "$TESTDATA/paints.paints.xml" -o $threads.xml
  done
  diff 1.xml 2.xml
  diff 1.xml 7.xml
}

@test "a large library is searched on paints that represent it" {
  awk 'BEGIN { print "sample,geometry,illuminant,observer,L,a,b"
    for (i = 0; i < 120; ++i) for (k = 1; k <= 5; ++k) {
      split("15 25 45 75 110", at, " ")
      printf "p%d,45as%d,D65,10,%.2f,%.2f,%.2f\n", i, at[k], 15 + 60 * exp(-(at[k] - 15) / (15 + i / 3)), i % 20, i % 7 } }' |
    paint-convert --quiet --from csv - -o library.paints.xml
  fit-basis "${quick[@]}" --quiet --representatives 0 library.paints.xml -o all.xml --report all.json
  fit-basis "${quick[@]}" --quiet --representatives 20 library.paints.xml -o some.xml --report some.json
  jq -e '.results.sets[0].searched_paints == 120' all.json
  jq -e '.results.paints == 120 and (.results.sets[0].searched_paints | . >= 20 and . < 100)' some.json
  jq -se '.[1].results.sets[0].objective < 1.01 * .[0].results.sets[0].objective' all.json some.json
  run fit-basis "${quick[@]}" --explain --representatives 20 library.paints.xml -o some.xml
  [[ "$output" == *"searched on 20 paints that represent all"* ]]
}

@test "both methods, targets and weights give a basis" {
  for choice in "--method lm" "--method power-mean" "--target curve" "--weights plain" "--name mine"; do
    fit-basis "${quick[@]}" $choice --quiet "$TESTDATA/paints.paints.xml" -o b.basis.xml
  done
  grep -q 'name="mine"' b.basis.xml
}

@test "measured BRDFs take part" {
  awk 'BEGIN { print "3\n400 550 700"
    for (ti = 0; ti < 1.3; ti += 0.2) for (to = 0; to < 1.3; to += 0.1) for (az = 0; az <= 3.1; az += 0.3) {
      c = cos(ti) * cos(to) - sin(ti) * sin(to) * cos(az); f = 0.02 + (c > 0 ? 0.3 * c ^ 9 : 0)
      print ti, 0, to, az, f, f, f } }' >nine.brdf
  fit-basis --quiet --lobes 1 --starts 2 nine.brdf -o b.basis.xml --report r.json
  exponent=$(sed -nE 's/.*<exponent>(.*)<.exponent>.*/\1/p' b.basis.xml)
  awk -v e="$exponent" 'BEGIN { exit !(e > 8.5 && e < 9.5) }'
  fit-basis "${quick[@]}" --quiet nine.brdf "$TESTDATA/paints.paints.xml" -o b.basis.xml --report r.json
  grep -q '"paints": 60' r.json
}

@test "the time limit is kept and told" {
  run fit-basis --lobes 1..11 --time-limit 0.2 "$TESTDATA/paints.paints.xml" -o b.basis.xml
  [ "$status" -eq 4 ]
  [ -s b.basis.xml ]
}

@test "--explain says what is done and left out" {
  run fit-basis "${quick[@]}" --explain "$TESTDATA/paints.paints.xml" -o b.basis.xml
  [ "$status" -eq 0 ]
  [[ "$output" == *"gloss: the rough coats of "[1-9]*" paints take part, with the mirror; a smooth coat asks for a mirror"* ]]
  [[ "$output" == *"left out: directions out of plane"* ]]
}

# gloss GU FILE: a library of three paints with that gloss at 60 deg.
gloss() {
  { echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'
    for L in 20 40 60; do
      echo "<paint name=\"p$L\"><gloss angle=\"60\">$1</gloss><appearance travel=\"60\"><face L=\"$((L * 3 / 2))\" a=\"5\" b=\"5\"/><flop L=\"$((L / 2))\" a=\"2\" b=\"2\"/></appearance></paint>"
    done
    echo '</paints>'; } >"$2"
}

@test "gloss is weighed: satin coats get sharp lobes, smooth ones none" {
  gloss 40 satin.xml
  gloss 90 smooth.xml
  for library in satin smooth; do
    fit-basis --quiet --lobes 4 --starts 1 --name b $library.xml -o $library.basis.xml
    sed -n 's/.*<exponent>\(.*\)<.exponent>/\1/p' $library.basis.xml >$library.txt
  done
  run diff -q satin.txt smooth.txt
  [ "$status" -eq 1 ]
  awk 'END { exit !($1 > 500) }' satin.txt
  awk 'END { exit !($1 < 500) }' smooth.txt
}

@test "a mirror is part of the search where paints state gloss, and can be asked for or left out" {
  gloss 40 satin.xml
  sed 's|<gloss.*</gloss>||' satin.xml >plain.xml
  mirror_of() { fit-basis "${quick[@]}" --quiet "$@" -o b.basis.xml && grep -c '<mirror/>' b.basis.xml; }
  [ "$(mirror_of satin.xml)" = 1 ]
  [ "$(mirror_of plain.xml)" = 0 ]
  [ "$(mirror_of --mirror no satin.xml)" = 0 ]
  [ "$(mirror_of --mirror yes plain.xml)" = 1 ]
  # Without it the lobes have to stand for the image in the coat.
  fit-basis --quiet --lobes 3 --starts 1 satin.xml -o b.basis.xml --report with.json
  fit-basis --quiet --lobes 3 --starts 1 --mirror no satin.xml -o b.basis.xml --report without.json
  jq -se '(.[0].results | .sets[0].max_error + .floor_max) < (.[1].results | .sets[0].max_error + .floor_max)' with.json without.json
}

@test "an exponent at its bound is told" {
  gloss 75 glossy.xml
  run fit-basis "${quick[@]}" --mirror no glossy.xml -o b.basis.xml --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" == *"the sharpest of 2 lobes is at its bound: "*"--mirror yes"* ]]
  jq -e '.results.sets[0].at_bound' r.json
  run fit-basis "${quick[@]}" glossy.xml -o b.basis.xml --report r.json
  [[ "$output" != *"at its bound"* ]]
  jq -e '.results.sets[0].at_bound | not' r.json
}

@test "seven lobes for the library beat those made by hand" {
  fit-basis --quiet --lobes 7 --starts 1 "$TESTDATA/paints.paints.xml" -o b.basis.xml
  fit-paint --quiet --basis b.basis.xml "$TESTDATA/paints.paints.xml" -o f.xml --report found.json
  fit-paint --quiet --basis "$TESTDATA/b7.basis.xml" "$TESTDATA/paints.paints.xml" -o f.xml --report by-hand.json
  jq -se '.[0].results.de00_mean < 0.95 * .[1].results.de00_mean' found.json by-hand.json
}

@test "wrong values are refused by name" {
  for wrong in "--lobes 0" "--lobes 3..1" "--lobes x" "--lobes 25" "--starts 0" "--mirror maybe" "--method best" "--target lab" \
    "--weights heavy" "--visible -1" "--seed x" "--time-limit x"; do
    run fit-basis $wrong "$TESTDATA/paints.paints.xml" -o b.basis.xml
    [ "$status" -eq 2 ]
    [[ "$output" == *"${wrong%% *}"* ]]
  done
  [ ! -e b.basis.xml ]
}

@test "a missing file, an empty library and a full disk exit 3 and leave no basis" {
  run fit-basis "${quick[@]}" nothing.xml -o b.basis.xml
  [ "$status" -eq 3 ]
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"/>' >empty.xml
  run fit-basis "${quick[@]}" empty.xml -o b.basis.xml
  [ "$status" -eq 3 ]
  [[ "$output" == *"no paint to choose a basis for"* ]]
  [ ! -e b.basis.xml ]
  run fit-basis "${quick[@]}" "$TESTDATA/paints.paints.xml" -o /dev/full
  [ "$status" -eq 3 ]
}
