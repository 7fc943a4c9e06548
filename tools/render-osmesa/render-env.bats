# render-osmesa under a prefiltered environment.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 128x64 -o small.exr
  prefilter-envmap -q small.exr --basis "$TESTDATA/b7.basis.xml" -o small.env.exr
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  shape=$TESTDATA/speed-shape.obj
  small="--size 96x54 --samples 1 --effects auto,-rays"
  open='<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
  lobes='<lobes space="lin_rec2020_scene" basis="b7" method="l1" max_de00="0" mean_de00="0">'
  echo "$open<paint name=\"matt\">$lobes<diffuse r=\"0.1\" g=\"0.2\" b=\"0.3\"/></lobes></paint>" \
    "<paint name=\"flake\">$lobes<diffuse r=\"0.01\" g=\"0.01\" b=\"0.02\"/>" \
    '<lobe exponent="20" ddr="0.1" ddg="0.1" ddb="0.2" gr="0" gg="0" gb="0"/>' \
    '<lobe exponent="900" ddr="0" ddg="0" ddb="0" gr="4" gg="4" gb="4"/></lobes></paint>' \
    "<paint name=\"other\">$lobes<diffuse r=\"0.01\" g=\"0.01\" b=\"0.02\"/>" \
    '<lobe exponent="33" ddr="0.1" ddg="0.1" ddb="0.2" gr="0" gg="0" gb="0"/></lobes></paint></paints>' >paints.xml
}

# number KEY: the number of that key in the report's error.
number() { sed -n '/"error": {/,/}/p' r.json | grep -m1 "\"$1\"" | sed -E 's/.*: ([-0-9.e+]+),?$/\1/'; }

# Matt paint has no approximation but the map of E = 1: 1e-3 by its tolerance and as much by the lookup between texels. A
# channel off by 2e-3 moves a* by at most 500/3 times that, 0.33.
@test "matt paint agrees with the reference integrator" {
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --check 100 -o out.exr --report r.json
  [ "$status" -eq 0 ]
  awk -v max="$(number de00_max)" 'BEGIN { exit !(max < 0.35) }'
  grep -q '"source": "small.exr"' r.json
}

@test "flake and gloss are told how far they are from it" {
  render-osmesa -q --mesh "$shape" -p paints.xml#flake --env small.env.exr $small --check 100 -o out.exr --report r.json
  awk -v mean="$(number de00_mean)" -v p95="$(number de00_p95)" -v max="$(number de00_max)" \
    'BEGIN { exit !(0 < mean && mean <= p95 && p95 <= max) }'
}

@test "the environment as background fills the picture" {
  render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --background env -o out.exr
  oiiotool out.exr --ch A --printstats | grep -q 'Stats Min: 1'
  render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr $small -o out.exr
  oiiotool out.exr --ch A --printstats | grep -q 'Stats Min: 0'
}

@test "without --light the buffers are those of the brightest direction, which the header holds" {
  render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --aov lambert -o out.exr
  exrheader out.exr | grep -A1 -q 'goniochrome:aovLight'
}

@test "buffers come with the rays, the lights and the environment they were seen in" {
  render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr --light 0,0,2,0.5,1,1 $small --aov mask -o out.exr
  exrheader out.exr >header
  grep -A1 'goniochrome:lights' header | grep -q '"0,0,1,0.5,1,1,0.53"'
  grep -A1 'goniochrome:environment' header | grep -q '"small.env.exr"'
  rays=$(grep -A1 'goniochrome:rays' header | grep -oE '"[^"]+"')
  [ "$(tr -cd ';' <<<"$rays" | wc -c)" -eq 2 ]
  [ "$(tr -cd ',' <<<"$rays" | wc -c)" -eq 6 ]
  [[ "$(grep 'goniochrome:eye' header | grep -oE '"[^"]+"')" =~ ^'"'[-0-9.e+]+,[-0-9.e+]+,[-0-9.e+]+'"'$ ]]
}

@test "a lobe that the environment lacks is named, with the command that makes it" {
  run render-osmesa --mesh "$shape" -p paints.xml#other --env small.env.exr $small -o lobe.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "small.env.exr: the environment has no lobe of exponent 33" ]]
  [[ "$output" =~ "prefilter-envmap small.exr --exponents 33 -o" ]]
  [ ! -e lobe.exr ]
}

@test "a moved source is looked for beside the environment, then named by --check-source, then done without" {
  mkdir -p moved elsewhere
  cp small.env.exr small.exr moved
  cp small.env.exr elsewhere
  cp paints.xml elsewhere
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env moved/small.env.exr $small --check 5 -o out.exr
  [ "$status" -eq 0 ]
  [[ ! "$output" =~ warning ]]
  cd elsewhere
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --check 5 -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ 'the source "small.exr" of small.env.exr is not there: its mirror part takes its place' ]]
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --check 5 --check-source ../small.exr -o out.exr
  [ "$status" -eq 0 ]
  [[ ! "$output" =~ warning ]]
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --check 5 --check-source nowhere.exr -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ nowhere.exr ]]
  [ ! -e none.exr ]
}

@test "--engine integral sums the image itself, within the tolerance" {
  to="--mesh $shape --env small.env.exr --size 64x36 --samples 1 --effects auto,-rays --check 40"
  render-osmesa -q $to -p paints.xml#flake --engine integral --tolerance 0.5 -o sum.exr --report r.json
  [ "$(jq '.results | .engine == "integral" and .error.de00_p95 <= 0.5 and .left_out.de00_p95 == 0' r.json)" = true ]
  [ "$(jq '[.results.plan[] | select(.needed and .decision != "forced off") | .decision == "drawn"] | all' r.json)" = true ]
  exrheader sum.exr | grep -q 'goniochrome:engine.*"integral"'
  render-osmesa -q $to -p paints.xml#flake --engine integral --tolerance 0.02 -o finer.exr --report finer.json
  [ "$(jq -s '.[0].results.error.de00_mean > .[1].results.error.de00_mean' r.json finer.json)" = true ]
  # The buffers are enough, and a lamp alone needs no image.
  render-osmesa -q --mesh "$shape" --env small.env.exr $small --aov normal,part -p paints.xml#flake -o buffers.exr
  render-osmesa -q --gbuffer buffers.exr --env small.env.exr -p paints.xml#flake --engine integral --tolerance 0.5 --check 40 -o again.exr --report r.json
  [ "$(jq '.results.error.de00_p95 <= 0.5' r.json)" = true ]
  render-osmesa -q --mesh "$shape" --light 30,50 $small -p paints.xml#flake --engine integral -o lamp.exr
  run render-osmesa $to -p paints.xml#flake --engine integral --check-source nowhere.exr -o none.exr
  [ "$status" -eq 3 ]
  [ ! -e none.exr ]
}

@test "an environment that was turned is checked, and summed, as it stands" {
  for change in "--rotate 90" "--exposure 1"; do
    prefilter-envmap -q small.exr --basis "$TESTDATA/b7.basis.xml" $change -o changed.env.exr
    for engine in cpu integral; do
      run render-osmesa --mesh "$shape" -p paints.xml#matt --env changed.env.exr $small --engine $engine --check 60 \
        -o out.exr --report r.json
      [ "$status" -eq 0 ]
      [[ "$output" =~ 'the source "small.exr" of changed.env.exr is turned, brightened or cut there' ]]
      awk -v mean="$(number de00_mean)" 'BEGIN { exit !(mean < 0.5) }'
    done
  done
}

@test "a file that is no environment is refused" {
  run render-osmesa --mesh "$shape" --env "$shape" $small -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ speed-shape.obj ]]
  [ ! -e none.exr ]
}

@test "--texture-maps looks lobes up in a cube for each exponent, or in the levels of one" {
  texture="$TESTDATA/wood.sbrdf.exr"
  part=$(sed -n 's/^[og] //p' "$shape" | head -1)
  prefilter-envmap -q small.exr -e 256 --size 64 --layout mip -o mip.env.exr
  for maps in cubes mip; do
    run render-osmesa --mesh "$shape" --env mip.env.exr $small --texture "$part=$texture" --texture-maps $maps --check 5 \
      -o $maps.exr --report $maps.json
    [ "$status" -eq 0 ]
    jq -e '.results.error.de00_p95 < 3' $maps.json
  done
  prefilter-envmap -q small.exr -e 4,16,64,256 -o quarters.env.exr
  render-osmesa -q --mesh "$shape" --env quarters.env.exr $small --texture "$part=$texture" --texture-maps cubes -o a.exr
  render-osmesa -q --mesh "$shape" --env quarters.env.exr $small --texture "$part=$texture" --texture-maps mip -o b.exr
  run cmp -s a.exr b.exr
  [ "$status" -eq 1 ]
}

@test "a texture whose lobes are sharper than all maps is refused with the command that makes them" {
  texture="$TESTDATA/wood.sbrdf.exr"
  part=$(sed -n 's/^[og] //p' "$shape" | head -1)
  prefilter-envmap -q small.exr -e 4,16 -o blunt.env.exr
  run render-osmesa -q --mesh "$shape" --env blunt.env.exr $small --texture "$part=$texture" -o blunt.exr
  [ "$status" -eq 3 ]
  [ ! -e blunt.exr ]
  [[ "$output" =~ "a texture has lobes of exponents from "[0-9.]+" to "([0-9.]+)", but the maps of the environment reach from 1 to 16" ]]
  [[ "$output" == *"\`prefilter-envmap small.exr --exponents 1,4,16,${BASH_REMATCH[1]} -o ENV.env.exr\`"* ]]
  # The command that it names makes what is missing.
  prefilter-envmap -q small.exr --exponents "1,4,16,${BASH_REMATCH[1]}" -o sharp.env.exr
  render-osmesa -q --mesh "$shape" --env sharp.env.exr $small --texture "$part=$texture" -o sharp.exr
  # A lamp needs no map.
  render-osmesa -q --mesh "$shape" --light 0,30@0 $small --texture "$part=$texture" -o lamp.exr
}

@test "--texture lays a surface of lobes, which is planned and checked" {
  texture="$TESTDATA/wood.sbrdf.exr"
  part=$(sed -n 's/^[og] //p' "$shape" | head -1)
  run render-osmesa --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --texture "$part=$texture*4" --explain \
    --check 5 -o wood.exr --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ texture\ +yes.*drawn.*"of what is seen is textured" ]]
  [[ "$output" =~ texture-0\ +yes ]]
  [ "$(jq '[.results.plan[] | select(.effect == "texture" and .truth_de00_p95 != null)] | length' r.json)" -eq 1 ]
  [ "$(jq .results.error.checked_pixels r.json)" -eq 5 ]
  run render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr $small --texture "$part=$texture*4" \
    --print-shader -o wood.exr
  [[ "$output" == *"#version 330 core"* && "$output" == *"//   texture: "* ]]
  render-osmesa -q --mesh "$shape" -p paints.xml#matt --env small.env.exr $small -o plain.exr
  run cmp -s wood.exr plain.exr
  [ "$status" -eq 1 ]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture "$texture" -o none.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "write PART=FILE.exr" ]]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture "$part=$texture*0" -o none.exr
  [ "$status" -eq 2 ]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture "$part=small.exr" -o none.exr
  [ "$status" -eq 3 ]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture "$part=$texture" --texture-maps mip -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "prefilter with quarters of the sharpest" ]]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture-maps tall -o none.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "cubes" ]]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --texture-maps
  [ "$status" -eq 2 ]
  run render-osmesa --mesh "$shape" --env small.env.exr $small --critical-angle bend -o none.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "slide-map" ]]
  [ ! -e none.exr ]
}

# Maps are looked up along the plane of incidence, or with round lobes alone, which is the control; the reference has the
# facets of the coat, and so has the engine integral.
@test "a satin coat is compared with its facets, which integral draws" {
  readings='<gloss angle="20">8</gloss><gloss angle="60">40</gloss><gloss angle="85">40</gloss>'
  sed '/name="reference_gray"/,/<\/paint>/s|<gloss angle="60">.*</gloss>|'"$readings|" "$TESTDATA/paints.paints.xml" >three.xml
  fit-paint -q -b "$TESTDATA/b7.basis.xml" three.xml#reference_gray -o satin.xml
  scene="--mesh $shape -p satin.xml --env small.env.exr --check-source small.exr --size 96x54 --samples 1 --check 60"
  run render-osmesa $scene --explain -o maps.exr --report r.json
  [ "$status" -le 1 ]
  [[ "$output" =~ "prefiltered maps cannot show it, the engines integral and path do" ]]
  satin='.results.plan[] | select(.effect == "satin")'
  [ "$(jq -r "$satin | .decision" r.json)" = dropped ]
  jq -e "$satin | .de00_p95 == null and .truth_de00_p95 > 1" r.json
  jq -e '.results.error.prefilter < 0.5' r.json
  run render-osmesa -q $scene --effects auto,-satin -o round.exr --report round.json
  [ "$status" -le 1 ]
  jq -e '.results.error.prefilter > 1' round.json
  render-osmesa -q $scene --effects auto,-rays --engine integral -o facets.exr --report i.json
  [ "$(jq -r "$satin | .decision" i.json)" = drawn ]
  jq -e '.results.error.de00_p95 < 0.3' i.json
}
