#!/usr/bin/env bats
# paint-edit from outside: every option, right and wrong.
bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR"
  library=$TESTDATA/paints.paints.xml
  ns='xmlns="urn:goniochrome:paint:1"'
  # A paint on its curve: face 60,40,20, flop 20,10,0, travel 75.
  cat >one.paints.xml <<XML
<paints $ns version="1">
  <paint name="one" class="metallic" code="X1">
    <measurement illuminant="D65" observer="10" instrument="meter">
      <lab geometry="45as15" L="60" a="40" b="20"/>
      <lab geometry="45as45" L="30" a="17.5" b="5"/>
      <lab geometry="45as75" L="20" a="10" b="0"/>
    </measurement>
    <gloss angle="60">90</gloss>
    <appearance travel="75"><face L="60" a="40" b="20"/><flop L="20" a="10" b="0"/></appearance>
    <lobes space="lin_rec2020_scene" basis="b" method="l2" max_de00="1" mean_de00="0.5">
      <diffuse r="0.01" g="0.01" b="0.01"/>
      <lobe exponent="10" ddr="0.1" ddg="0.1" ddb="0.1" gr="0" gg="0" gb="0"/>
    </lobes>
  </paint>
</paints>
XML
  cat >gray.paints.xml <<XML
<paints $ns version="1">
  <paint name="gray" class="solid">
    <measurement illuminant="D65" observer="10">
      <lab geometry="45as15" L="50" a="0" b="0"/>
      <lab geometry="45as45" L="50" a="0" b="0"/>
      <lab geometry="45as110" L="50" a="0" b="0"/>
    </measurement>
  </paint>
</paints>
XML
}

# attribute FILE PAINT XPATH: an attribute's value.
attribute() {
  xmllint --xpath "string(//*[local-name()='paint'][@name='$2']$3)" "$1"
}
child() { printf "/*[local-name()='%s']" "$1"; }
names() { xmllint --xpath "//*[local-name()='paint']/@name" "$1" | sed -E 's/.*"(.*)"/\1/'; }

@test "a hue shift turns face, flop and rows, and drops the lobes with a word" {
  run paint-edit one.paints.xml --hue-shift 90 -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"paints: 1 read, 1 edited, 1 written; dropped because they no longer hold: lobes"* ]]
  ! grep -q '<lobe' out.paints.xml || false
  ! grep -q instrument out.paints.xml || false
  printf '%.6f %.6f\n' "$(attribute out.paints.xml one "$(child appearance)$(child face)/@a")" \
    "$(attribute out.paints.xml one "$(child appearance)$(child face)/@b")" >got
  grep -qx -- '-20.000000 40.000000' got
  [ "$(attribute out.paints.xml one /@code)" = X1 ]
  xmllint --noout out.paints.xml
}

@test "averages are reached" {
  paint-edit one.paints.xml --quiet --hue 120 --chroma 30 --lightness 40 --report r.json -o out.paints.xml
  jq -e '.results.changes[0] | .before.face == [60, 40, 20] and .de00_max > 5' r.json
  # Over 15, 45 and 110 deg: curve values at these from face, flop and travel 75.
  jq -e '.results.changes[0].after as $p | ([15, 45, 75] | map(pow((75 - .) / 60; 2))) as $w |
    [$w[] as $x | [range(3) as $i | $p.flop[$i] + ($p.face[$i] - $p.flop[$i]) * $x]] as $q |
    (([$q[][0]] | add / 3) - 40 | fabs < 1e-9) and
    (([$q[] | (.[1] * .[1] + .[2] * .[2] | sqrt)] | add / 3) - 30 | fabs < 1e-9) and
    ((([$q[][2]] | add) as $b | ([$q[][1]] | add) as $a | ($b / $a) + 1.7320508075688772) | fabs < 1e-9)' r.json
}

@test "--at at the face moves the face, at the travel the flop, between both" {
  for at in 15 75 45; do
    paint-edit one.paints.xml --quiet --at $at --share source --lightness-shift 8 --report $at.json -o $at.paints.xml
  done
  jq -e '.results.changes[0].after | .face[0] == 68 and .flop[0] == 20' 15.json
  jq -e '.results.changes[0].after | .face[0] == 60 and .flop[0] == 28' 75.json
  jq -e '.results.changes[0].after | .face[0] == 64 and .flop[0] == 24' 45.json
  # The row at 45 deg moves by what the curve moves there: 1/4 of the face's 4 and 3/4 of the flop's 4.
  [ "$(attribute 45.paints.xml one "$(child measurement)$(child lab)[2]/@L")" = 34 ]
}

@test "--at moves the color at the angle by exactly what is asked, of rows and of the curve" {
  paint-edit one.paints.xml --quiet --at 45 --lightness-shift 10 --report r.json -o out.paints.xml
  [ "$(attribute out.paints.xml one "$(child measurement)$(child lab)[2]/@L")" = 40 ]
  jq -e '.results.changes[0].after | .face[0] == 64 and .flop[0] == 32' r.json # 1/4 of 4 and 3/4 of 12
  # A paint with a residual: its reading moves by 10, and so does its curve.
  paint-edit "$library#silver_fine" --quiet --at 45 --lightness-shift 10 -o silver.paints.xml
  [ "$(attribute silver.paints.xml silver_fine "$(child measurement)$(child lab)[@geometry='45as45']/@L")" = 77.35 ]
}

@test "face, flop and travel that are set outright are what the rows read" {
  run paint-edit "$library#silver_fine" --face 45,55,30 --flop 20,25,12 --travel 70 --report r.json -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"dropped because they no longer hold: residual of the rows"* ]]
  row() { xmllint --xpath "string(//*[@geometry='$2']/@$3)" "$1"; }
  [ "$(row out.paints.xml 45as15 L) $(row out.paints.xml 45as15 a) $(row out.paints.xml 45as15 b)" = "45 55 30" ]
  [ "$(row out.paints.xml 45as110 L) $(row out.paints.xml 45as110 a) $(row out.paints.xml 45as110 b)" = "20 25 12" ]
  jq -e '.results.changes[0].restated_de00 > 1' r.json
  # The residual of the curve is kept where that is asked for, and with shifts.
  paint-edit "$library#silver_fine" --quiet --face 45,55,30 --flop 20,25,12 --travel 70 --keep-residual -o kept.paints.xml
  row kept.paints.xml 45as15 L | awk '{ exit !($1 < 44) }'
  paint-edit "$library#silver_fine" --quiet --flop-shift 1,0,0 --report r.json -o shifted.paints.xml
  jq -e '.results.changes[0] | has("restated_de00") | not' r.json
}

@test "a single reading is set, and the curve is fitted to all rows" {
  paint-edit one.paints.xml --quiet --set 45as45=35,20,6 --set 110=19,9,0 --report r.json -o out.paints.xml
  [ "$(attribute out.paints.xml one "$(child measurement)$(child lab)[2]/@L")" = 35 ]
  [ "$(attribute out.paints.xml one "$(child measurement)$(child lab)[1]/@L")" = 60 ]
  [ "$(attribute out.paints.xml one "$(child measurement)$(child lab)[4]/@geometry")" = 45as110 ]
  jq -e '.results.changes[0] | .fitted_de00 > 0 and .after.travel_deg != 75' r.json
}

@test "a paint is made from nothing" {
  run paint-edit --new dune --face 70,5,25 --flop 30,4,12 --travel 60 --gloss 90 --code S1 --class metallic --anisotropy 0.05,0.3 --report r.json -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"paints: 0 read, 1 made, 1 written"* ]]
  [ "$(names out.paints.xml)" = dune ]
  [ "$(attribute out.paints.xml dune /@code) $(attribute out.paints.xml dune /@class)" = "S1 metallic" ]
  [ "$(attribute out.paints.xml dune "$(child appearance)$(child face)/@L") $(attribute out.paints.xml dune "$(child gloss)")" = "70 90" ]
  [ "$(attribute out.paints.xml dune "$(child anisotropy)/@alphaY")" = 0.3 ]
  jq -e '.results.changes[0].after | .anisotropy == [0.05, 0.3] and .gloss_60_deg == 90' r.json
  paint-edit --quiet --new white --face 90,0,1 -o white.paints.xml
  [ "$(attribute white.paints.xml white /@class)" = solid ]
  paint-edit --quiet --new read --set 15=60,1,2 --set 45=40,1,2 --set 110=20,1,2 -o read.paints.xml
  [ "$(attribute read.paints.xml read "$(child appearance)$(child face)/@L")" = 60 ]
}

@test "names, codes and anisotropy are changed" {
  paint-edit one.paints.xml --quiet --rename two --code X2 --class pearl --anisotropy 0.1,0.2 -o out.paints.xml
  [ "$(names out.paints.xml) $(attribute out.paints.xml two /@code) $(attribute out.paints.xml two /@class)" = "two X2 pearl" ]
  grep -q '<lobe' out.paints.xml # the color did not move
  paint-edit out.paints.xml --quiet --no-code -o plain.paints.xml
  ! grep -q ' code=' plain.paints.xml || false
  run -2 paint-edit out.paints.xml --quiet --code X2 --no-code
  paint-edit out.paints.xml --quiet --anisotropy 0,0 -o round.paints.xml
  ! grep -q '<anisotropy' round.paints.xml || false
  paint-edit out.paints.xml --quiet --flakes 40,0.2 --report r.json -o coarse.paints.xml
  grep -q '<flakes diameter_um="40" coverage="0.2" spread_deg="0.5"/>' coarse.paints.xml
  jq -e '.results.changes[0].after.flakes == [40, 0.2, 0.5]' r.json
  # Every tool that reads and writes paints keeps them.
  paint-convert --quiet coarse.paints.xml -o kept.paints.xml
  fit-paint --quiet --basis "$TESTDATA/b5.basis.xml" kept.paints.xml -o fitted.paints.xml
  paint-edit fitted.paints.xml --quiet --flop-shift 1,0,0 -o moved.paints.xml
  grep -q '<flakes diameter_um="40" coverage="0.2" spread_deg="0.5"/>' moved.paints.xml
  paint-edit moved.paints.xml --quiet --flakes 0,0 -o none.paints.xml
  ! grep -q '<flakes' none.paints.xml || false
  run paint-edit "$library" --rename two -o all.paints.xml
  [ "$status" -eq 2 ]
  [[ $output == *"--rename is for one paint"* ]]
  [ ! -e all.paints.xml ]
}

@test "black has no color" {
  run paint-edit one.paints.xml --lightness-shift -40 -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"one: clipped: flop: L* -20.00 to 0"* ]]
  [[ $output == *"one: clipped: flop: chroma 10.00 to 0, as black has none"* ]]
  ! grep -qE ' L="0" a="[^0]' out.paints.xml || false
  [ "$(attribute out.paints.xml one "$(child measurement)$(child lab)[1]/@a")" = 40 ]
}

@test "variations near the end of the gloss scale differ, and those beyond it are told" {
  sed 's/<gloss angle="60">90/<gloss angle="60">92.1/' one.paints.xml >high.paints.xml
  run paint-edit high.paints.xml --variations gloss -o v.paints.xml
  [ "$status" -eq 1 ]
  [[ $output == *"left out: one.gloss+10: gloss: 102.1 to 100, the end of the scale"* ]]
  diff <(names v.paints.xml) <(printf '%s\n' one one.gloss-{20,15,10,5} one.gloss+5)
  [ "$(grep -c '<gloss' v.paints.xml)" = "$(grep '<gloss' v.paints.xml | sort -u | wc -l)" ]
}

@test "face, flop, travel and gloss are set and shifted" {
  paint-edit one.paints.xml --quiet --face 70,-5,3 --flop-shift -2,1,-1 --travel 100 --gloss 20 --report r.json -o out.paints.xml
  jq -e '.results.changes[0].after | .face == [70, -5, 3] and .flop == [18, 11, -1] and .travel_deg == 100 and .gloss_60_deg == 20' r.json
  paint-edit one.paints.xml --quiet --face-shift=-1,0,0 --flop 10,0,0 --travel-shift -20 --gloss-shift -15 --report r.json -o out.paints.xml
  jq -e '.results.changes[0].after | .face == [59, 40, 20] and .flop == [10, 0, 0] and .travel_deg == 55 and .gloss_60_deg == 75' r.json
}

@test "a paint with rows alone is fitted, and says how well" {
  paint-edit "$library#candy_blue" --quiet --flop-shift 3,0,0 --report r.json -o out.paints.xml
  jq -e '.results.changes[0] | .fitted_de00 > 0 and .after.travel_deg > 15' r.json
  [ -n "$(attribute out.paints.xml candy_blue "$(child appearance)/@travel")" ]
}

@test "--only edits one paint and passes the others on as they are" {
  paint-edit "$library" --quiet --only signal_red --lightness-shift 2 -o out.paints.xml
  diff <(names "$library") <(names out.paints.xml)
  readings() { xmllint --xpath "//*[local-name()='paint'][@name!='signal_red']//*[local-name()='lab']" "$1"; }
  diff <(readings "$library") <(readings out.paints.xml)
  [ "$(attribute out.paints.xml signal_red "$(child measurement)$(child lab)[1]/@L")" = 44.96 ]
  [ "$(attribute out.paints.xml jet_black "$(child measurement)$(child lab)[1]/@L")" = 4.12 ]
}

@test "--only with a name that is not there tells so and exits 1" {
  run paint-edit "$library" --only signal_rad --lightness-shift 2 -o out.paints.xml
  [ "$status" -eq 1 ]
  [[ $output == *'no paint is named "signal_rad"'* ]]
}

@test "--suffix names the edited paints" {
  paint-edit "$library#signal_red" --quiet --lightness-shift 2 --suffix _2 -o out.paints.xml
  [ "$(names out.paints.xml)" = signal_red_2 ]
}

@test "eight variations of each kind, named" {
  for what in face flop; do
    paint-edit "$library#silver_fine" --quiet --variations $what --step 6 -o v.paints.xml
    diff <(names v.paints.xml) <(printf '%s\n' silver_fine silver_fine.$what-{lighter,darker,red,yellow,green,cyan,blue,magenta})
  done
  paint-edit one.paints.xml --quiet --variations travel --step 10 -o v.paints.xml
  diff <(names v.paints.xml) <(printf '%s\n' one one.travel-{40,30,20,10} one.travel+{10,20,30,40})
  paint-edit one.paints.xml --quiet --variations gloss --step 2.5 -o v.paints.xml
  diff <(names v.paints.xml) <(printf '%s\n' one one.gloss-{10,7.5,5,2.5} one.gloss+{2.5,5,7.5,10})
}

@test "variations beyond the domain are left out and told" {
  run paint-edit one.paints.xml --variations travel --step 30 -o v.paints.xml
  [ "$status" -eq 1 ]
  [[ $output == *"one: left out: travel: it would go from 75 deg to -45 deg"* ]]
  diff <(names v.paints.xml) <(printf '%s\n' one one.travel-30 one.travel+{30,60,90})
}

@test "a gradient runs through all paints of the stream" {
  paint-edit "$library#ice_blue" "$library#candy_blue" one.paints.xml --quiet --gradient 2 --report r.json -o g.paints.xml
  diff <(names g.paints.xml) <(printf '%s\n' ice_blue ice_blue-candy_blue.{1,2} candy_blue candy_blue-one.{1,2} one)
  jq -e '.results | .read == 3 and .written == 7 and (.changes | length == 4) and .changes[1].fraction > 0.66' r.json
  # 45as45 of ice_blue has L* 65.7, of candy_blue 29.14.
  xmllint --xpath "string(//*[@name='ice_blue-candy_blue.1']//*[@geometry='45as45']/@L)" g.paints.xml | grep -q '^53.51'
}

@test "a gradient without common geometries keeps the observer, and says what it left out" {
  sed 's/observer="10"/observer="2"/' one.paints.xml >two_degrees.paints.xml
  sed 's/"45as/"r45as/; s/name="one"/name="other"/' two_degrees.paints.xml >other.paints.xml
  run paint-edit two_degrees.paints.xml other.paints.xml --gradient 1 -o g.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"one to other: 0 of 3 and 3 measured geometries are common to both and kept"* ]]
  [ "$(attribute g.paints.xml one-other.1 "$(child measurement)/@observer")" = 2 ]
  paint-edit g.paints.xml --quiet --hue-shift 3 -o again.paints.xml
}

@test "a paint goes on before the next one comes" {
  { sed '/<\/paints>/d' one.paints.xml; sleep 4; echo '</paints>'; } | paint-edit --quiet --hue-shift 2 | {
    # The writer's first 0.5 s must already hold the whole paint.
    timeout 3 grep -qm1 '</paint>'
  }
}

@test "a gradient of one paint says what it takes" {
  run paint-edit one.paints.xml --gradient 2 -o g.paints.xml
  [ "$status" -eq 1 ]
  [[ $output == *"a gradient takes two or more"* ]]
}

@test "a gradient between two observers is refused" {
  sed 's/observer="10"/observer="2"/; s/name="one"/name="other"/' one.paints.xml >two.paints.xml
  run paint-edit one.paints.xml two.paints.xml --gradient 2 -o g.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'"other" for D65/2: convert one of them first'* ]]
  [ ! -e g.paints.xml ]
}

@test "a gray takes no hue, keeps its other moves and the status is 1" {
  run paint-edit gray.paints.xml --hue 90 --lightness-shift 5 -o out.paints.xml
  [ "$status" -eq 1 ]
  [[ $output == *"gray: left out: hue: the average chroma 0.00 is below 1"* ]]
  [ "$(attribute out.paints.xml gray "$(child measurement)$(child lab)[1]/@L")" = 55 ]
}

@test "lightness stops at black and says so" {
  run paint-edit one.paints.xml --flop-shift -30,0,0 -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"one: clipped: flop: L* -10.00 to 0"* ]]
}

@test "works in a pipe and keeps the history" {
  paint-edit <one.paints.xml --quiet --lightness-shift 1 | paint-edit --quiet --travel-shift 5 - >out.paints.xml
  [ "$(xmllint --xpath "count(//*[local-name()='processing'])" out.paints.xml)" = 2 ]
  [ "$(attribute out.paints.xml one "$(child appearance)/@travel")" = 80 ]
}

@test "the same bytes for any number of threads" {
  for n in 1 2 7; do paint-edit "$library" --quiet --flop-shift 2,1,0 --threads $n -o - | grep -v '<processing' >$n; done
  cmp 1 2
  cmp 1 7
}

@test "--explain tells the plan before the work" {
  run paint-edit one.paints.xml --explain --at 40 --hue-shift 10 --only one -o out.paints.xml
  [ "$status" -eq 0 ]
  [[ $output == *"at 40 deg: the color changes by the shifts"* ]]
  [[ $output == *"left as they are: all paints but one"* ]]
}

usage_error() { # TEXT ARGUMENTS...
  local text=$1
  shift
  run paint-edit one.paints.xml -o out.paints.xml "$@"
  [ "$status" -eq 2 ] || { echo "$* gave $status: $output"; return 1; }
  [[ $output == *"$text"* ]] || { echo "$* said: $output"; return 1; }
  [ ! -e out.paints.xml ]
}

@test "usage errors name the option and the remedy" {
  usage_error "there is nothing to do"
  usage_error "--hue is given 2 numbers: give one" --hue 1,2
  usage_error "--hue is \"blue\": give a number from -360 to 360" --hue blue
  usage_error "--chroma is \"-1\"" --chroma -1
  usage_error "--lightness is \"x\"" --lightness x
  usage_error "--hue-shift is \"400\"" --hue-shift 400
  usage_error "--chroma-factor is \"-2\"" --chroma-factor -2
  usage_error "--lightness-shift is \"1,5\"" --lightness-shift 1,5
  usage_error "--at lacks its move" --at 30
  usage_error "--at takes shifts" --at 30 --hue 20
  usage_error "--at is \"200\"" --at 200 --hue-shift 2
  usage_error "--face is given 2 numbers: give three" --face 1,2
  usage_error "--face has L* -3" --face -3,2,1
  usage_error "--flop has L* -3" --flop=-3,2,1
  usage_error "--face-shift is given 1 numbers" --face-shift 1
  usage_error "--flop-shift is given 4 numbers" --flop-shift 1,2,3,4
  usage_error "--travel is 15: it lies above 15 and up to 180" --travel 15
  usage_error "--travel is \"181\"" --travel 181
  usage_error "--travel-shift is \"far\"" --travel-shift far
  usage_error "--gloss is \"101\"" --gloss 101
  usage_error "--gloss-shift is \"\"" --gloss-shift ""
  usage_error "--gloss-angle is \"45\": give 20, 60, 85" --gloss-angle 45 --gloss 3
  usage_error "--variations is \"hue\": give face, flop, travel, gloss" --variations hue
  usage_error "--step is 0" --variations face --step 0
  usage_error "exclude each other" --variations face --gradient 2
  usage_error "take no other move" --variations face --hue 2
  usage_error "--suffix is for moves" --variations face --suffix x
  usage_error "--only is not for it" --gradient 2 --only one
  usage_error "--gradient is \"2.5\"" --gradient 2.5
  usage_error "did you mean --travel?" --travle 30
  usage_error "--share is for --at" --share source --hue-shift 3
  usage_error "--share is \"half\": give exact, source" --share half --at 30 --hue-shift 3
  usage_error "--keep-residual is for --face, --flop and --travel" --keep-residual --hue-shift 3
  usage_error "--set is \"45as45\": write GEOMETRY=L,A,B" --set 45as45
  usage_error "--set is \"45as45=1,2\": write GEOMETRY=L,A,B" --set 45as45=1,2
  usage_error "--set: geometry \"45xx\" is not understood" --set 45xx=1,2,3
  usage_error "--set has L* -1" --set 45as45=-1,2,3
  usage_error "--set names 45as45 twice" --set 45=1,2,3 --set 45as45=1,2,3
  usage_error "--anisotropy is given 1 numbers: give two" --anisotropy 0.1
  usage_error "--flakes is given 1 numbers: give diameter and coverage" --flakes 30
  usage_error "--flakes has coverage 2: it is a part of the surface" --flakes 30,2
  usage_error "--flakes is 0,0.1: give two numbers above 0" --flakes 0,0.1
  usage_error "--flakes has spread 31: one flake spreads light by up to 30 deg" --flakes 30,0.5,31
  usage_error "--anisotropy is 0,0.1: give two numbers above 0" --anisotropy 0,0.1
  usage_error "--rename and --suffix exclude each other" --rename x --suffix y
  usage_error "--class is \"mat\"" --class mat
  usage_error "--new makes a paint and reads none" --new x --face 1,2,3
  usage_error "take no other move" --variations face --code X
}

@test "a new paint says what it lacks" {
  new_error() { # TEXT ARGUMENTS...
    local text=$1
    shift
    run paint-edit --new x -o out.paints.xml "$@"
    [ "$status" -eq 2 ] && [[ $output == *"$text"* ]] && [ ! -e out.paints.xml ] || { echo "$* said: $output"; return 1; }
  }
  new_error "--new lacks a color: give --face" --gloss 40
  new_error "--flop and --travel of a --new paint need --face" --flop 1,2,3 --set 45=1,2,3
  new_error "--new has a flop and no travel: give --travel" --face 40,2,3 --flop 1,2,3
  new_error "--new names its paint" --face 40,2,3 --suffix y
  new_error "--new makes one paint: leave --only out" --face 40,2,3 --only x
  new_error "--new makes one paint: pipe it" --variations gloss
}

@test "input errors name the file and leave no output" {
  run paint-edit missing.paints.xml --hue 3 -o out.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *missing.paints.xml* ]]
  run paint-edit one.paints.xml#two --hue 3 -o out.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'one.paints.xml: no paint is named "two"'* ]]
  head -c 400 one.paints.xml >cut.paints.xml
  run paint-edit cut.paints.xml --hue 3 -o out.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *cut.paints.xml:* ]]
  [ ! -e out.paints.xml ]
}

@test "an input without paints is told, and is no success" {
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"/>' >none.xml
  run --separate-stderr paint-edit none.xml --hue 3 -o out.paints.xml
  [ "$status" -eq 1 ]
  [[ $stderr == *"the input holds no paints: nothing was edited"* ]]
}
