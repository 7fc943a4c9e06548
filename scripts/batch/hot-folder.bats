#!/usr/bin/env bats
# The hot folder of the recipes: exports are averaged and judged once, whatever happens on the way.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR"
  mkdir inbox
  export SETTLE=0
  head=sample,geometry,illuminant,observer,L,a,b
  panel standard 50 >standard.csv
  paint-convert -q standard.csv -o standard.paints.xml
  printf 'geometry,quantity,low,high\n*,dL,-1,1\n' >limits.csv
}

# panel NAME L...: a table with one reading of a name for each lightness.
panel() {
  local name=$1 mark='' number=1 L
  shift
  echo $head
  for L; do
    for angle in 15 45 110; do echo "$name$mark,45as$angle,D65,10,$L,0,0"; done
    number=$((number + 1)) mark=" ($number)"
  done
}

folder() {
  "$BATS_TEST_DIRNAME/recipes/hot-folder" --once inbox results standard.paints.xml --limits limits.csv
}

@test "an export is averaged, compared and reported" {
  panel good 49.5 51 51.5 >inbox/a.csv
  run folder
  echo "$output"
  [ "$status" -eq 0 ]
  jq -e '[.results.compared, .results.failed, .results.judgements[0].sample] == [1,0,"good"]' results/a.csv.json
  [ "$(ls results | xargs)" = "a.csv.html a.csv.json a.csv.paints.xml" ]
}

@test "a batch that fails gives 1, and again when nothing is new" {
  panel good 50.5 >inbox/a.csv
  panel bad 53 >inbox/b.csv
  run folder
  [ "$status" -eq 1 ]
  [[ $output == *'"bad" fails against "standard": 45as15: dL 3, limit 1: too light near gloss'* ]]
  touch -d '1 hour ago' inbox/*
  cp results/a.csv.json before
  run folder
  [ "$status" -eq 1 ]
  [ -z "$output" ]
  cmp before results/a.csv.json
}

@test "a file cut in the middle is an error until it is whole" {
  panel good 50 | head -c 60 >inbox/a.csv
  run folder
  [ "$status" -eq 3 ]
  [ -e results/a.csv.error ]
  [ ! -e results/a.csv.json ]
  run folder
  [ "$status" -eq 3 ]
  panel good 50 >inbox/a.csv
  run folder
  [ "$status" -eq 0 ]
  [ ! -e results/a.csv.error ]
  [ -e results/a.csv.json ]
}

@test "a run that was killed leaves nothing that counts as done" {
  panel good 50 >inbox/a.csv
  mkdir -p results/.hot-folder
  echo half >results/a.csv.html
  echo half >results/.hot-folder/report.json
  run folder
  [ "$status" -eq 0 ]
  jq -e '.results.compared == 1' results/a.csv.json
  grep -q '</html>' results/a.csv.html
  [ ! -e results/.hot-folder ]
}

@test "it waits for new files until it is stopped" {
  PERIOD=0.1 "$BATS_TEST_DIRNAME/recipes/hot-folder" inbox results standard.paints.xml --limits limits.csv 2>/dev/null &
  panel good 50 >inbox/part
  mv inbox/part inbox/a.csv
  for _ in $(seq 100); do
    [ ! -e results/a.csv.json ] || break
    sleep 0.1
  done
  kill $!
  ! wait $! || false
  jq -e '.results.compared == 1' results/a.csv.json
}
