# Ten scenes, planned and with everything: what is left out is not seen, and what is forced out is what the plan said.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 128x64 -o studio.exr
  oiiotool "$TESTDATA/outdoor.exr" --resize:filter=box 128x64 -o outdoor.exr
  for light in studio outdoor; do prefilter-envmap -q $light.exr --basis "$TESTDATA/b5.basis.xml" -o $light.env.exr; done
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  sed 's/<lobes /<anisotropy alphaX="0.05" alphaY="0.3"\/><lobes /' fitted.xml >brushed.xml
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  view="--mesh $TESTDATA/speed-shape.obj --size 96x54 --samples 1"
}

# error FILE: the p95 of the checked pixels.
error() { sed -n '/"error": {/,/}/p' "$1" | grep -m1 de00_p95 | sed -E 's/.*: ([-0-9.e+]+),?$/\1/'; }

# scene PAINT LIGHT...: the picture of the plan is no farther from the exact one than that of all effects, plus the
# tolerance.
scene() {
  local paint=$1
  shift
  for effects in all auto; do
    render-osmesa -q $view --check 60 -p "$paint" "$@" --effects $effects,-rays -o $effects.exr --report $effects.json || [ $? -eq 1 ] || return 1
  done
  awk -v all="$(error all.json)" -v auto="$(error auto.json)" 'BEGIN { exit !(auto <= all + 0.5) }' && return 0
  echo "$paint $*: $(error all.json) with everything, $(error auto.json) as planned"
  return 1
}

# decided EFFECT DECISION: as the report of the last scene has it.
decided() { grep -A4 "\"effect\": \"$1\"" auto.json | grep -q "\"decision\": \"$2\""; }

@test "a solid paint is planned and checked" {
  scene fitted.xml#signal_white --env outdoor.env.exr
  decided anisotropy "not in the scene"
  scene fitted.xml#signal_white --env studio.env.exr
  scene fitted.xml#signal_white --light 40,50@0
  decided mirror "not in the scene"
  decided operator "not in the scene"
}

@test "a metallic paint is planned and checked" {
  scene fitted.xml#candy_red --env outdoor.env.exr
  scene fitted.xml#candy_red --env studio.env.exr
  decided fresnel drawn
  scene fitted.xml#candy_red --light 40,50
  scene fitted.xml#candy_red --light 40,50,0.2,0.6,1
  decided operator drawn
}

@test "a brushed metal is planned and checked" {
  scene brushed.xml#silver_black_flop --light 40,50
  decided anisotropy drawn
  scene brushed.xml#silver_black_flop --light 40,50,1,0.5,0.2
  decided operator drawn
  scene brushed.xml#candy_red --light -30,20
}

@test "--tilts: fewer tilted normals of a brushed paint err more, and what cannot be is refused" {
  brushed() { # TILTS: the mean difference from the reference integrator
    render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --size 48x27 --samples 1 --paint brushed.xml#silver_black_flop \
      --env studio.env.exr --check-source studio.exr --effects auto,-rays --check 8,model --tilts "$1" -o tilts.exr --report r.json
    jq .results.error.de00_mean r.json
  }
  few=$(brushed 3) && many=$(brushed 0.005)
  awk -v few="$few" -v many="$many" 'BEGIN { exit !(few > 2 * many) }' || { echo "$few and $many"; return 1; }
  for bad in 0 8193 1.5 0. -1 many; do
    run render-osmesa $view --paint brushed.xml#silver_black_flop --env studio.env.exr --tilts=$bad -o none.exr
    [ "$status" -eq 2 ]
    [[ $output == *"--tilts is \"$bad\": write how many"* ]]
  done
}

# Forced out, the error that the check shows is the one that the plan predicted, within a factor of 2.
@test "--check tells what the plan left out" {
  run render-osmesa $view --check 5 -p fitted.xml#candy_red --env studio.env.exr --effects all,-rays,-mirror -o off.exr --report off.json
  [ "$status" -le 1 ]
  [[ "$output" =~ left\ out:\ dE00\ p95\ [1-9] ]]
  for key in de00_mean de00_p95 de00_max shading_ms shading_all_ms; do
    sed -n '/"left_out": {/,/}/p' off.json | grep -q "\"$key\": [0-9]"
  done
  render-osmesa -q $view --check 5 -p fitted.xml#candy_red --env studio.env.exr --effects all,-rays -o all.exr --report all.json || [ $? -eq 1 ]
  sed -n '/"left_out": {/,/}/p' all.json | grep -qE '"de00_max": 0(\.0)?,?$'
}

@test "--check against the model has a verdict, and tells how well the checked pixels know it" {
  off="$view -p fitted.xml#candy_red --env studio.env.exr --effects all,-rays,-lobes"
  run render-osmesa -q $off --check 60,model -o off.exr --report off.json
  echo "$output"
  [ "$status" -eq 1 ]
  [[ $output == *"the picture is farther from the reference than --tolerance 1 allows"* ]]
  jq -e '.results.error | .de00_p95_low < .de00_p95 and .de00_p95 < .de00_p95_high' off.json
  # The range of a part of the pixels holds the figure of all of them, within two standard errors.
  render-osmesa -q $off --tolerance 100 --check 100000,model -o off.exr --report all.json
  jq -e '.results.error | .de00_p95_low == .de00_p95 and .de00_p95 == .de00_p95_high' all.json
  jq -e --slurpfile all all.json '.results.error as $e | $all[0].results.error.de00_p95 as $p |
    $p > 2 * $e.de00_p95_low - $e.de00_p95 and $p < 2 * $e.de00_p95_high - $e.de00_p95' off.json
  # A tolerance within the range is left open.
  run render-osmesa $off --tolerance "$(jq .results.error.de00_p95 off.json)" --check 60,model -o off.exr
  [ "$status" -eq 0 ]
  [[ $output == *"60 pixels leave it open whether p95 is within --tolerance"*"--check 240 narrows it"* ]]
}

# Every pixel is checked: near the outline an effect is worth ten times its mean, and few pixels do not tell its 95th
# percentile.
@test "an effect forced off errs by what the plan predicted" {
  for effect in fresnel mirror lobes; do
    render-osmesa -q $view --check 2000 -p fitted.xml#candy_red --env studio.env.exr --effects all,-rays,-$effect -o off.exr \
      --report off.json || [ $? -eq 1 ]
    awk -v plan="$(grep -m1 plan_de00_p95 off.json | sed -E 's/.*: ([-0-9.e+]+),?$/\1/')" -v truth="$(error off.json)" \
      -v effect=$effect 'BEGIN { print effect, plan, truth; exit !(truth < 2 * plan && truth > plan / 2) }'
  done
}

# The white paint in an even light of 1. The control is the same paint without its coat.
@test "a white paint in even light is not brighter than the light" {
  oiiotool --pattern constant:color=1,1,1 64x32 3 -d float -o even.exr
  prefilter-envmap -q even.exr --basis "$TESTDATA/b7.basis.xml" -o even.env.exr
  fit-paint -q --basis "$TESTDATA/b7.basis.xml" "$TESTDATA/paints.paints.xml" -o coated.xml
  grep -v '<coat ' coated.xml >uncoated.xml
  # brightest LIBRARY ENGINE
  brightest() {
    render-osmesa -q $view -p "$1.xml#arctic_white" --env even.env.exr --engine "$2" --effects all,-rays --exposure 0 -o even-$2.exr || return 1
    oiiotool --stats even-$2.exr | sed -nE 's/.*Stats Max: ([0-9.]+) .*/\1/p' | head -1
  }
  for engine in cpu gl integral; do
    awk -v most="$(brightest coated $engine)" 'BEGIN { exit !(most > 0.9 && most <= 1.005) }'
    awk -v most="$(brightest uncoated $engine)" 'BEGIN { exit !(most > 1.5) }'
  done
}

# A plate of 10 cm in the sun, seen from 30 cm.
@test "flakes sparkle near by in the sun, and the plan says why where they do not" {
  printf 'v -.05 -.05 0\nv .05 -.05 0\nv .05 .05 0\nv -.05 .05 0\nf 1 2 3 4\n' >plate.obj
  paint-edit -q fitted.xml#silver_fine --flakes 60,0.5 -o coarse.xml
  paint-edit -q fitted.xml#silver_fine --flakes 0.5,0.5 -o dust.xml
  look() { run render-osmesa --mesh plate.obj --size 120x90 --samples 1 --camera 0,0,0.3,0,0,0,15 --explain -p "$@"; }
  look coarse.xml --light 10,10 -o near.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ sparkle.*drawn.*"flakes of 60 um, coverage 0.5; seen up to some" ]]
  look coarse.xml --light 10,10 --effects auto,-sparkle -o mean.exr
  [[ "$output" =~ sparkle.*"forced off" ]]
  ! cmp -s near.exr mean.exr || false
  look dust.xml --light 10,10 -o dust.exr
  [[ "$output" =~ sparkle.*dropped ]]
  look fitted.xml#silver_fine --light 10,10 -o assumed.exr
  [[ "$output" =~ sparkle.*dropped.*"(assumed by class)".*"+sparkle draws those assumed" ]]
  look coarse.xml --env outdoor.env.exr -o sky.exr
  [[ "$output" =~ sparkle.*"made without --sparkle" ]]
  look coarse.xml --light 10,10 --engine path --time-limit 1 -o path.exr
  [[ "$output" =~ sparkle.*dropped.*"the engine path draws the mean of all flakes" ]]
  [[ "$output" != *"no sparkle is drawn"* ]]
  for engine in path integral; do
    run render-osmesa --mesh plate.obj --size 12x9 --camera 0,0,0.3,0,0,0,15 -p coarse.xml --light 10,10 \
      --engine $engine --time-limit 1 --effects auto,+sparkle -o refused.exr
    [ "$status" -eq 0 ]
    [[ "$output" == *"no sparkle is drawn: the engine $engine draws the mean of all flakes"* ]]
  done
  for engine in cpu gl; do
    look coarse.xml --light 10,10 --engine $engine --effects auto,+sparkle -o $engine.exr
    [[ "$output" =~ sparkle.*"forced on" ]]
    ! cmp -s $engine.exr mean.exr || false
  done
  # Both draw the same flakes.
  idiff -q -fail 0.01 -failpercent 1 -warn 1 cpu.exr gl.exr
}

# A cloud lies before the sun, and the sky is three times as bright above as at the horizon.
@test "flakes of a whole car under a cloud are not drawn, and the plan has their prediction beside the truth" {
  oiiotool --pattern fill:topleft=1,1,1:topright=1,1,1:bottomleft=.3,.3,.3:bottomright=.3,.3,.3 64x32 3 -o cloud.exr
  prefilter-envmap -q --sparkle --basis "$TESTDATA/b5.basis.xml" cloud.exr -o cloud.env.exr
  paint-edit -q fitted.xml#silver_coarse --flakes 30,0.5 -o silver.xml
  whole() { render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --camera 35,12,1 --size 160x90 --samples 1 -p silver.xml --env cloud.env.exr --check 60 --explain "$@"; }
  whole --effects auto,-rays -o whole.exr --report cloud.json || [ $? -eq 1 ]
  jq -e '.results.plan[] | select(.effect == "sparkle") |
    .decision == "dropped" and .de00_p95 < 0.1 and .truth_de00_p95 < 0.1' cloud.json
  # The control: flakes of 1 mm are seen, and the truth is near the prediction.
  paint-edit -q fitted.xml#silver_coarse --flakes 1000,0.5 -o silver.xml
  whole --effects auto,-rays -o whole.exr --report large.json || [ $? -eq 1 ]
  jq -e '.results.plan[] | select(.effect == "sparkle") |
    .de00_p95 > 0.1 and .truth_de00_p95 > 0.5 * .de00_p95 and .truth_de00_p95 < 2 * .de00_p95' large.json
}
