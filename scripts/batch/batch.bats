#!/usr/bin/env bats
# scripts/batch without a workflow engine: what a batch makes, that the shards do not matter, and what it says about bad paints.

batch() {
  "$BATS_TEST_DIRNAME/paint-batch" "$@"
}

# whole OUT OPTION...: a whole batch of ten paints, of which one cannot be read and one has no color.
whole() {
  local out=$1 n
  shift
  batch plan library.paints.xml --out "$out" --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml" "$@"
  for n in $(batch list "$out"); do batch shard "$out" "$n"; done
  batch merge "$out" 2>"$out/said"
}

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  paint-convert -q "$TESTDATA/paints.paints.xml" -o - | paint-stats -q -f paints -w 'class==metallic' >metallic.xml
  {
    awk '/<paint / && ++n > 8 { exit } { print }' metallic.xml
    echo '<paint name="no_color" class="solid"><gloss angle="60">90</gloss></paint>'
    echo '<paint name="misread"><measurement illuminant="D65" observer="10"><lab geometry="45as15" L="12,5" a="0" b="0"/></measurement></paint>'
    echo '</paints>'
  } >library.paints.xml
  whole one --shard-paints 100
}

setup() {
  cd "$BATS_FILE_TMPDIR"
}

@test "every paint has a row, a fit and a picture" {
  [ "$(tail -n +2 one/report.tsv | wc -l)" -eq 9 ]
  [ "$(jq .fitted one/report.json)" -eq 8 ]
  [ "$(jq .pictures one/report.json)" -eq 8 ]
  [ "$(find one/pictures -name '*.png' | wc -l)" -eq 8 ]
  file one/pictures/*/000000.png | grep -q '64 x 48'
  xmllint --noout --schema "$TESTDATA/../lib/formats/paint.xsd" one/fitted.paints.xml
}

@test "bad paints are reported by name and do not end the batch" {
  jq -r '.rejected[]' one/report.json | grep -q '12,5'
  [ "$(jq -r '.failed[].name' one/report.json)" = no_color ]
  [ -n "$(jq -r '.failed[0].fit' one/report.json)" ]
}

@test "elements named paint of another vocabulary are no paints, in a paint and beside it" {
  {
    sed -n '1,/<paints/p' metallic.xml
    echo '<paint xmlns="urn:other"/><box xmlns="urn:other"><paint name="boxed">x</paint></box><!-- <paint> -->'
    echo '<o:paint xmlns:o="urn:other"><o:paint/></o:paint>'
    sed -n '/<paint /,/<\/paint>/p' metallic.xml | awk '{ print } /<\/paint>/ { exit }' |
      sed 's|</paint>|<paint xmlns="urn:other" name="inner">a note</paint></paint>|'
    echo '<o:paint xmlns:o="urn:other"/></paints>'
  } >foreign.xml
  batch plan foreign.xml --out foreign --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml"
  [ "$(jq .paints foreign/plan.json)" -eq 1 ]
  batch shard foreign 0
  batch merge foreign
  [ "$(jq .fitted foreign/report.json)" -eq 1 ]
  [ "$(jq .pictures foreign/report.json)" -eq 1 ]
}

@test "the report is the same for any shards" {
  whole three --shard-paints 3
  whole each --shard-paints 1
  for other in three each; do
    cmp one/report.tsv "$other/report.tsv"
    cmp one/report.json "$other/report.json"
    cmp one/fitted.paints.xml "$other/fitted.paints.xml"
    diff -r one/pictures "$other/pictures"
  done
}

@test "a shard that is done is not done again, and one that was interrupted keeps its pictures" {
  cp -r one again
  sed -i "s|$PWD/one|$PWD/again|g" again/plan.json
  batch shard again 0
  [ "$(cat again/shards/0000/log)" = $'begun\nfinished' ]
  rm again/shards/0000/done.json
  rm again/pictures/*/000003.png
  touch -d 2000-01-01 again/pictures/*/*.png
  batch shard again 0
  [ "$(find again/pictures -name '*.png' -newermt 2001-01-01 | wc -l)" -eq 1 ]
  batch merge again
  cmp one/report.tsv again/report.tsv
}

@test "one run draws all paints of a shard, and a shard that is killed while it draws keeps what was drawn" {
  mkdir counted
  printf '#!/bin/sh\necho run >>"%s/runs"\nexec %q "$@"\n' "$PWD" "$(command -v render-osmesa)" >counted/render-osmesa
  chmod +x counted/render-osmesa
  for tool in fit-paint paint-stats goniogeom-index colorsnap; do ln -s "$(command -v "$tool")" counted/; done
  cp -r one killed
  sed -i "s|$PWD/one|$PWD/killed|g" killed/plan.json
  rm -r killed/shards killed/pictures/*/*.png
  PATH=$PWD/counted:$PATH batch shard killed 0
  [ "$(wc -l <runs)" -eq 1 ]
  diff -r one/pictures killed/pictures
  # What a killed run leaves: pictures that have not got their names yet, and a part of one.
  rm killed/shards/0000/done.json
  mkdir killed/shards/0000/drawn
  scene=$(jq -r '.scenes[0].name' killed/plan.json)
  jq -n --arg scene "$scene" '{scene: $scene, numbers: [2, 4, 5]}' >killed/shards/0000/drawn/numbers.json
  cp -p "killed/pictures/$scene/000002.png" killed/shards/0000/drawn/0001.png
  touch -d 2000-01-01 "killed/pictures/$scene"/*.png killed/shards/0000/drawn/0001.png
  rm "killed/pictures/$scene"/00000{2,4,5}.png
  echo part >killed/shards/0000/drawn/.0002.png.partial
  batch shard killed 0
  diff -r one/pictures killed/pictures
  [ "$(find killed/pictures -name '*.png' -newermt 2001-01-01 | wc -l)" -eq 2 ]
  [ ! -e killed/shards/0000/drawn ]
  batch merge killed
  cmp one/report.tsv killed/report.tsv
}

@test "brushed paints are drawn by runs of their own, so that no picture depends on the paints before it" {
  {
    sed '/<\/paints>/d' metallic.xml | awk '/<paint / && ++n > 3 { exit } { print }'
    awk '/<paint /, /<\/paint>/' metallic.xml | awk '{ print } /<\/paint>/ { exit }' |
      sed 's|name="[^"]*"|name="brushed"|; s|</paint>|<anisotropy alphaX="0.05" alphaY="0.3"/></paint>|'
    echo '</paints>'
  } >brushed.xml
  for size in 100 1; do
    batch plan brushed.xml --out "brushed-$size" --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml" --shard-paints "$size"
    for n in $(batch list "brushed-$size"); do batch shard "brushed-$size" "$n"; done
  done
  [ "$(find brushed-1/pictures -name '*.png' | wc -l)" -eq 4 ]
  diff -r brushed-100/pictures brushed-1/pictures
}

@test "the plan tells its estimate, and the merged report tells the time beside it" {
  run batch plan library.paints.xml --out told --env --explain --basis "$TESTDATA/b5.basis.xml"
  [ "$status" -eq 0 ]
  [[ ${lines[0]} == 'plan: library.paints.xml, about 10 paints' ]]
  [[ $output == *'in shards: '*' s of work'*'measured: '*'estimate: '*' s of work'* ]]
  # The plan is announced before anything is prepared, and therefore also before the preparation fails.
  run batch plan nowhere.xml --out nothing --env --explain
  [ "$status" -eq 3 ]
  [[ ${lines[0]} == 'plan: nowhere.xml, about 0 paints' ]]
  grep -qE 'time in tools: [0-9.]+ s, estimated [0-9.]+ s' one/said
}

@test "a chapter of the book holds the pictures that were drawn" {
  batch book one 0
  [ "$(grep -oE 'data:image/png;base64' one/book-001.html | wc -l)" -ge 8 ]
}

@test "options: missing, wrong, right" {
  run batch plan
  [ "$status" -eq 2 ]
  run batch plan library.paints.xml --out x --size big
  [ "$status" -eq 2 ]
  [[ $output == *'"big": give width x height'* ]]
  run batch plan nowhere.xml --out x --env
  [ "$status" -eq 3 ]
  [[ $output == *nowhere.xml* ]]
  run batch plan library.paints.xml --out x --env a/light.exr b/light.exr
  [ "$status" -eq 2 ]
  [[ $output == *'--env has light twice: pictures would share its name'* ]]
  run batch shard one ten
  [ "$status" -eq 2 ]
  for command in list "shard 0" merge "book 0"; do
    read -r name number <<<"$command"
    # shellcheck disable=SC2086
    run batch $name nowhere $number
    [ "$status" -eq 3 ]
    [[ $output == *'nowhere: there is no batch: `paint-batch plan LIBRARY --out '* ]]
  done
  run batch shard one 99
  [ "$status" -eq 3 ]
  [[ $output == *'there is no shard 99: they are numbered 0 to '* ]]
  run batch book one 99
  [ "$status" -eq 3 ]
  [[ $output == *'there is no chapter 99: they are numbered 0 to '* ]]
}
