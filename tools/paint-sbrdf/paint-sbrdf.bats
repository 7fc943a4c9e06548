#!/usr/bin/env bats
# paint-sbrdf from outside: every option, right and wrong.

setup() {
  cd "$BATS_TEST_TMPDIR"
  ns='xmlns="urn:goniochrome:paint:1"'
  weights() { # weights NAME BASIS DIFFUSE EXPONENT WEIGHT
    echo "<paint name=\"$1\"><lobes space=\"lin_rec2020_scene\" basis=\"$2\" method=\"stated\" max_de00=\"0\" mean_de00=\"0\">"
    echo "<diffuse r=\"$3\" g=\"$3\" b=\"$3\"/>"
    echo "<lobe exponent=\"$4\" ddr=\"$5\" ddg=\"$5\" ddb=\"$5\" gr=\"0\" gg=\"0\" gb=\"0\"/></lobes></paint>"
  }
  { echo "<paints $ns version=\"1\">" && weights dark b 0.0625 8 0.5 && weights light b 0.25 8 1 && weights sharp b 0.125 64 2 &&
    echo '</paints>'; } >p.xml
  wood=$TESTDATA/wood.sbrdf.exr
}

# channel FILE NAME X Y: a value of a texel. The texels of a file are printed once, because oiiotool starts slowly.
channel() {
  local texels=${1##*/}.txt
  [ "$texels" -nt "$1" ] || oiiotool --info -v --dumpdata "$1" >"$texels"
  awk -v name="$2" -v at="($3, $4):" 'sub(/.*channel list: /, "") { n = split($0, names, ", ") }
    sub(/.*Pixel /, "") && index($0, at) == 1 { for (i = 1; i <= n; i++) if (names[i] == name) print $(i + 2) }' "$texels"
}
size() { oiiotool --info "$1" | grep -oE '[0-9]+ x +[0-9]+' | tr -d ' '; }
gray() { # gray FILE W H BYTES...: a gray picture, bytes as octal numbers
  printf 'P5\n%d %d\n255\n' "$2" "$3" >"$1"
  printf "$(printf '\\%s' "${@:4}")" >>"$1"
}

@test "one paint is a map whose texels are its lobes" {
  paint-sbrdf -q p.xml#dark --size 3x2 --report r.json -o m.exr
  [ "$(size m.exr)" = 3x2 ]
  [ "$(channel m.exr diffuse.R 2 1)" = 0.062500000 ]
  [ "$(channel m.exr lobe0.n 0 0)" = 8.000000000 ]
  [ "$(channel m.exr lobe0.G 0 0)" = 0.500000000 ]
  jq -e '[.results.size, .results.lobes, .results.exponents, .results.surfaces[0].kind, .results.refitted_texels]
    == [[3,2],1,[8,8],"paint",0]' r.json
  [ "$(jq .results.albedo_max r.json)" != null ]
}

@test "a stripe lies where it is told, and its edge is a mixture of both paints" {
  paint-sbrdf -q p.xml#dark p.xml#light --stripe 0.25,0.625 --size 4x4 -o m.exr
  [ "$(channel m.exr diffuse.R 0 3)" = 0.062500000 ]
  [ "$(channel m.exr diffuse.R 0 2)" = 0.250000000 ]
  [ "$(channel m.exr diffuse.R 0 1)" = 0.156250000 ]
  [ "$(channel m.exr lobe0.R 0 1)" = 0.750000000 ]
  [ "$(channel m.exr diffuse.R 0 0)" = 0.062500000 ]
  paint-sbrdf -q p.xml#dark p.xml#light --stripe 0.25,0.625 --angle 90 --size 4x4 -o turned.exr
  [ "$(channel turned.exr diffuse.R 1 0)" != "$(channel turned.exr diffuse.R 3 0)" ]
  [ "$(channel turned.exr diffuse.R 1 0)" = "$(channel turned.exr diffuse.R 1 3)" ]
  paint-sbrdf -q 'p.xml#dark,light,sharp' --stripe 0,0.25,0.5,0.75 --size 4x4 --report r.json -o three.exr
  jq -e '[.results.surfaces[].share] == [0.5,0.25,0.25]' r.json
  [ "$(channel three.exr diffuse.R 0 1)" = 0.125000000 ]
}

@test "gradients and mixtures of paints on one basis are exact and need no further lobe" {
  paint-sbrdf -q p.xml#dark p.xml#light --gradient --size 8x1 --report r.json -o m.exr
  jq -e '[.results.lobes, .results.refitted_texels] == [1,0]' r.json
  awk -v a="$(channel m.exr diffuse.R 0 0)" -v b="$(channel m.exr diffuse.R 7 0)" 'BEGIN { exit !(a < 0.08 && b > 0.23) }'
  paint-sbrdf -q p.xml#dark p.xml#light --mix 0.5 --size 1x1 -o one.exr
  [ "$(channel one.exr lobe0.R 0 0)" = 0.750000000 ]
  paint-sbrdf -q p.xml --mix 0.25,0.5 --size 1x1 --report r.json -o three.exr
  jq -e '[.results.lobes, .results.exponents] == [2,[8,64]]' r.json
  [ "$(channel three.exr lobe1.R 0 0)" = 1.000000000 ]
}

@test "a mask has a paint for each step of gray, and a decal lies where it is white" {
  gray mask.pgm 3 1 000 200 377
  paint-sbrdf -q p.xml --mask mask.pgm -o m.exr
  [ "$(size m.exr)" = 3x1 ]
  [ "$(channel m.exr diffuse.R 0 0) $(channel m.exr diffuse.R 1 0) $(channel m.exr diffuse.R 2 0)" = "0.062500000 0.250000000 0.125000000" ]
  paint-sbrdf -q p.xml --mask mask.pgm --invert -o m.exr
  [ "$(channel m.exr diffuse.R 0 0)" = 0.125000000 ]
  gray white.pgm 2 1 377 377
  paint-sbrdf -q p.xml#dark p.xml#light --decal white.pgm --place 0.5,0.5,0.5 --size 8x8 --report r.json -o d.exr
  [ "$(channel d.exr diffuse.R 3 4)" = 0.250000000 ]
  [ "$(channel d.exr diffuse.R 1 4)" = 0.062500000 ]
  [ "$(channel d.exr diffuse.R 3 2)" = 0.062500000 ]
  jq -e '.results.surfaces[1].share == 0.125' r.json
}

@test "pictures become the diffuse part, and their gloss comes from a mask" {
  printf 'P6\n1 1\n255\n\377\377\377' >white.ppm
  paint-sbrdf -q white.ppm --gloss 1 --mirror 256 --report r.json -o m.exr
  awk -v d="$(channel m.exr diffuse.G 0 0)" 'BEGIN { exit !(d > 0.3182 && d < 0.3185) }'
  jq -e '[.results.exponents, .results.surfaces[0].kind] == [[256,256],"picture"]' r.json
  gray half.pgm 2 1 000 377
  paint-sbrdf -q white.ppm --gloss half.pgm --size 2x1 -o g.exr
  [ "$(channel g.exr lobe0.R 0 0)" = 0.000000000 ]
  [ "$(channel g.exr lobe0.R 1 0)" != 0.000000000 ]
}

@test "a layer of a picture is named in brackets" {
  oiiotool --create 4x4 6 --chnames a.R,a.G,a.B,b.R,b.G,b.B --fill:color=.1,.1,.1,.4,.4,.4 4x4 -o layers.exr
  refused 3 "several layers have colors: a, b" paint-sbrdf layers.exr
  paint-sbrdf -q "layers.exr[b]" --size 2x2 -o b.exr
  [[ "$(oiiotool b.exr --ch diffuse.G --printstats | sed -n 's/.*Stats Avg: //p')" == 0.127* ]] # .4 / pi
}

@test "maps are resampled, cut, tiled, turned, worn and polished" {
  paint-sbrdf -q "$wood" -o same.exr
  for place in "3 5" "100 27"; do
    for channel in diffuse.R lobe0.R lobe0.n lobe0.x; do
      [ "$(channel same.exr $channel $place)" = "$(channel "$wood" $channel $place)" ]
    done
  done
  paint-sbrdf -q "$wood" --crop 3,5,2,1 --tile 2x3 -o cut.exr
  [ "$(size cut.exr)" = 4x3 ]
  [ "$(channel cut.exr lobe0.n 2 2)" = "$(channel "$wood" lobe0.n 3 5)" ]
  paint-sbrdf -q "$wood" --crop 3,5,1,1 --polish 0.5 -o sharp.exr
  paint-sbrdf -q "$wood" --crop 3,5,1,1 --wear 0.5 -o wide.exr
  awk -v n="$(channel "$wood" lobe0.n 3 5)" -v s="$(channel sharp.exr lobe0.n 0 0)" -v w="$(channel wide.exr lobe0.n 0 0)" \
    -v a="$(channel "$wood" lobe0.R 3 5)" -v t="$(channel sharp.exr lobe0.R 0 0)" \
    'function same(x, y) { return x < 1.001 * y && y < 1.001 * x }
     BEGIN { exit !(same(s + 1, 4 * (n + 1)) && same(w + 1, (n + 1) / 4) && same(t, 4 * a)) }'
  paint-sbrdf -q "$TESTDATA/nameplate.sbrdf.exr" --crop 0,0,1,1 --turn 45 -o turned.exr
  awk -v c="$(channel turned.exr frame.c 0 0)" -v s="$(channel turned.exr frame.s 0 0)" 'BEGIN { exit !(c * c < 1e-6 && s * s > 0.999) }'
  run paint-sbrdf "$wood" --size 16x16 --crop 0,0,2,2 --report r.json -o small.exr
  [ "$status" -eq 0 ]
  [[ "$output" == *" texels fitted, with errors of "* ]]
  [ "$(jq -c '[.results.lobes, .results.refitted_texels > 0, .results.refit_error_max < 0.3, .results.refit_error_max > 0]' r.json)" = \
    '[1,true,true,true]' ]
}

@test "maps with other lobes stand side by side, and mixtures keep all lobes or as many as are asked for" {
  paint-sbrdf -q "$wood" "$TESTDATA/brushed.sbrdf.exr" p.xml#dark --mosaic 3 --size 9x3 --report r.json -o m.exr
  jq -e '.results.lobes == 3' r.json
  [ "$(channel m.exr diffuse.R 8 0)" = 0.062500000 ]
  paint-sbrdf -q p.xml#dark p.xml#sharp --mix 0.5 --size 1x1 --lobes 1 --report r.json -o one.exr
  jq -e '[.results.lobes, .results.refitted_texels] == [1,1]' r.json
  awk -v n="$(channel one.exr lobe0.n 0 0)" 'BEGIN { exit !(n > 8 && n < 64) }'
  paint-sbrdf -q "$wood" --lobes 1 --size 64x64 --crop 4,4,8,8 --threads 1 -o a.exr
  paint-sbrdf -q "$wood" --lobes 1 --size 64x64 --crop 4,4,8,8 --threads 3 -o b.exr
  for channel in diffuse.R lobe0.n lobe0.R; do [ "$(channel a.exr $channel 7 7)" = "$(channel b.exr $channel 7 7)" ]; done
}

@test "brushed surfaces of different directions are mixed exactly, each lobe with a direction of its own" {
  paint-sbrdf -q "$TESTDATA/nameplate.sbrdf.exr" --crop 0,0,1,1 -o along.exr
  paint-sbrdf -q along.exr --turn 40 -o askew.exr
  paint-sbrdf -q along.exr askew.exr --mix 0.5 --report r.json -o both.exr
  jq -e '[.results.lobes, .results.lobe_frames, .results.refitted_texels] == [5,true,0]' r.json  # the round lobe is the same in both
  # A half of each lobe, with the angle of its own surface.
  awk -v a="$(channel along.exr lobe0.R 0 0)" -v b="$(channel both.exr lobe0.R 0 0)" -v c="$(channel both.exr lobe0.c 0 0)" \
    -v d="$(channel both.exr lobe1.c 0 0)" 'BEGIN { exit !(b > 0.499 * a && b < 0.501 * a && (c - d) ^ 2 > 0.1) }'
  # Written and read again it is the same, and a quarter of a turn needs no further frames.
  paint-sbrdf -q both.exr --tile 2x1 --report r.json -o again.exr
  jq -e '[.results.lobe_frames, .results.refitted_texels] == [true,0]' r.json
  for name in lobe0.R lobe1.R lobe0.c lobe1.s lobe1.n; do
    [ "$(channel again.exr $name 1 0)" = "$(channel both.exr $name 0 0)" ] || { echo "$name"; false; }
  done
  paint-sbrdf -q along.exr --turn 90 -o across.exr
  paint-sbrdf -q along.exr across.exr --mix 0.5 --report r.json -o cross.exr
  jq -e '[.results.lobe_frames, .results.refitted_texels] == [false,0]' r.json
  # Where fewer lobes are asked for, one direction has to do.
  paint-sbrdf -q along.exr askew.exr --mix 0.5 --lobes 2 --report r.json -o few.exr
  jq -e '[.results.lobes, .results.lobe_frames, .results.refitted_texels] == [2,false,1]' r.json
  oiiotool both.exr --ch "$(oiiotool --info -v both.exr | grep -oP 'channel list: \K.*' | tr -d ' ' | sed 's/lobe1.s,*//; s/,$//')" -o part.exr
  refused 3 "give c and s of every lobe" paint-sbrdf part.exr
}

@test "where none lies, the map has alpha, which changes and mixtures keep" {
  paint-sbrdf -q none p.xml#light --stripe 0.25,0.625 --size 4x4 --report r.json -o m.exr
  for row in "0 0.000000000 0.000000000" "1 0.500000000 0.125000000" "2 1.000000000 0.250000000" "3 0.000000000 0.000000000"; do
    read -r y alpha diffuse <<<"$row"
    [ "$(channel m.exr alpha 1 "$y") $(channel m.exr diffuse.R 1 "$y")" = "$alpha $diffuse" ] || { echo "$y"; false; }
  done
  jq -e '[.results.alpha_mean, .results.surfaces[0].kind] == [0.375,"nothing"]' r.json
  paint-sbrdf -q m.exr --crop 1,1,1,2 --tile 2x1 -o cut.exr
  [ "$(channel cut.exr alpha 1 0) $(channel cut.exr alpha 1 1)" = "0.500000000 1.000000000" ]
  paint-sbrdf -q m.exr --size 2x2 -o half.exr
  [ "$(channel half.exr alpha 0 0) $(channel half.exr alpha 0 1)" = "0.250000000 0.500000000" ]
  paint-sbrdf -q m.exr p.xml#dark --mix 0.5 -o mixed.exr
  [ "$(channel mixed.exr alpha 0 0) $(channel mixed.exr alpha 0 2)" = "0.500000000 1.000000000" ]
  paint-sbrdf -q p.xml#light p.xml#dark --mix 0.5 --size 1x1 --report r.json -o all.exr
  jq -e '.results.alpha_mean == 1' r.json
  run oiiotool --info -v all.exr
  [[ "$output" != *alpha* ]]
  oiiotool m.exr --mulc 2 -o wrong.exr
  refused 3 "give a number from 0 to 1" paint-sbrdf wrong.exr
}

@test "--explain tells the surfaces, the pattern and the map" {
  run paint-sbrdf p.xml#dark "$wood" --stripe 0.4,0.6 --explain -o m.exr
  [[ "$output" == *"surface 1: paint dark, 1 lobes"* && "$output" == *"128 x 128 texels"* && "$output" == *"exact"* ]]
}

# refused STATUS WORDS COMMAND...: one line, and for usage (2) another that points to --help
refused() {
  run "${@:3}" -o none.exr
  [ "$status" -eq "$1" ] && [[ "$output" == *"$2"* ]] && [ "$(wc -l <<<"$output")" -le $(($1 == 2 ? 2 : 1)) ] && [ ! -e none.exr ] || {
    echo "${*:3}: $status: $output"
    return 1
  }
}

@test "options that do not fit are usage errors" {
  refused 2 "say where each lies" paint-sbrdf p.xml
  refused 2 "name another one" paint-sbrdf p.xml#dark --gradient
  refused 2 "exclude each other" paint-sbrdf p.xml --gradient --mosaic 2
  refused 2 "one for each stripe" paint-sbrdf p.xml --stripe 0.1,0.2
  refused 2 "begins and ends" paint-sbrdf p.xml#dark p.xml#light --stripe 0.1
  refused 2 "lower number first" paint-sbrdf p.xml#dark p.xml#light --stripe 0.2,0.1
  refused 2 "each surface but the first" paint-sbrdf p.xml --mix 0.5
  refused 2 "adds up to 1.5" paint-sbrdf p.xml --mix 0.75,0.75
  refused 2 "--place is for --decal" paint-sbrdf p.xml#dark --place 1,1,1
  refused 2 "--invert is for" paint-sbrdf p.xml#dark --invert
  refused 2 "--size is \"big\"" paint-sbrdf p.xml#dark --size big
  refused 2 "at most" paint-sbrdf p.xml#dark --size 16384x16384
  refused 2 "which is 256 x 256" paint-sbrdf p.xml#dark --crop 0,0,300,2
  refused 2 "--tile is \"0x1\"" paint-sbrdf p.xml#dark --tile 0x1
  refused 2 "from 0 to 1" paint-sbrdf p.xml#dark --wear 2
}

@test "surfaces that are none are bad input" {
  refused 3 "cannot" paint-sbrdf absent.sbrdf.exr
  refused 3 "no paint is named" paint-sbrdf p.xml#nobody
  sed '/<paint /,/<\/paint>/d' p.xml >empty.xml
  refused 3 "empty.xml: holds no paint" paint-sbrdf empty.xml
  refused 3 "fit-paint" paint-sbrdf "$TESTDATA/paints.paints.xml#candy_red"
  sed 's/basis="b"/basis="c"/' p.xml >other.xml
  refused 3 "fit all with one basis" paint-sbrdf p.xml#dark other.xml#light --gradient
  sed 's|<lobes|<anisotropy alphaX="0.05" alphaY="0.3"/><lobes|' p.xml >brushed.xml
  refused 3 "is brushed" paint-sbrdf brushed.xml#dark
  refused 3 "absent.png" paint-sbrdf p.xml#dark p.xml#light --mask absent.png
  refused 3 "absent.png" paint-sbrdf p.xml#dark --wear absent.png
  names=diffuse.R,diffuse.G,diffuse.B,lobe0.R,lobe0.G,lobe0.B,lobe0.x,lobe0.y,lobe0.z,lobe0.n
  map() { oiiotool --create 1x1 10 --chnames $names --fill:color="$1" 1x1 -d float -o bad.sbrdf.exr; }
  map 0,0,0,1,1,1,0,0,0,8
  refused 3 "the axes of lobe0 of texel (0,0) are 0" paint-sbrdf bad.sbrdf.exr
  map 0,0,0,-1,1,1,-1,-1,1,8
  refused 3 "lobe0.R of texel (0,0) is -1" paint-sbrdf bad.sbrdf.exr
  map 0,0,0,1,1,1,-1,-1,1,nan
  refused 3 "lobe0.n of texel (0,0) is nan" paint-sbrdf bad.sbrdf.exr
  oiiotool --create 1x1 9 --chnames ${names%,*} -d float -o bad.sbrdf.exr
  refused 3 "is not known" paint-sbrdf bad.sbrdf.exr
  map 0.1,0.1,0.1,1,1,1,-1,-1,1,8
  paint-sbrdf -q bad.sbrdf.exr --size 3x3 -o fine.exr
  oiiotool --create 16384x1 10 --chnames $names --fill:color=0.1,0.1,0.1,0.1,0.1,0.1,-1,-1,1,8 16384x1 -d float -o wide.sbrdf.exr
  paint-sbrdf -q wide.sbrdf.exr -o fine.exr
  [ "$(size fine.exr)" = 16384x1 ]
}

@test "a map and paints come from standard input" {
  paint-sbrdf -q "$wood" --wear 0.5 -o worn.sbrdf.exr
  paint-sbrdf -q - --tile 2x1 -o piped.exr <worn.sbrdf.exr
  paint-sbrdf -q worn.sbrdf.exr --tile 2x1 -o named.exr
  oiiotool piped.exr named.exr --fail 0 --diff
  paint-sbrdf -q "$wood" | paint-sbrdf -q - p.xml#dark --mix 0.5 -o mixed.exr
  paint-sbrdf -q --size 1x1 -o light.exr -- "-#light" <p.xml
  [ "$(channel light.exr diffuse.R 0 0)" = 0.250000000 ]
}
