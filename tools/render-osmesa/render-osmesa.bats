# render-osmesa from the outside: options, pictures, files, exit statuses.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  shape=$TESTDATA/speed-shape.obj
  light="--light 30,40"
  small="--size 96x54 --samples 1 --effects auto,-rays"
  # Three panels side by side, facing +Z.
  cat >panels.obj <<'OBJ'
v -1.5 -0.5 0
v -1.5 0.5 0
v -0.5 -0.5 0
v -0.5 0.5 0
v 0.5 -0.5 0
v 0.5 0.5 0
v 1.5 -0.5 0
v 1.5 0.5 0
o left
usemtl lacquer
f 1 3 4 2
o middle
usemtl glass
f 3 5 6 4
o right
usemtl lacquer
f 5 7 8 6
OBJ
  matt() { # NAME R G B: a matt paint of those reflectances
    awk -v n="$1" -v r="$2" -v g="$3" -v b="$4" 'BEGIN { p = atan2(0, -1)
      printf "<paint name=\"%s\"><lobes space=\"lin_rec2020_scene\" basis=\"none\" method=\"l1\" max_de00=\"0\" mean_de00=\"0\">", n
      printf "<diffuse r=\"%.9g\" g=\"%.9g\" b=\"%.9g\"/></lobes></paint>\n", r / p, g / p, b / p }'
  }
  {
    echo '<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
    matt red 0.8 0.1 0.1
    matt green 0.1 0.8 0.1
    matt white 1 1 1
    echo '<paint name="bare"><measurement illuminant="D65" observer="10"><lab geometry="45as45" L="50" a="0" b="0"/></measurement></paint>'
    echo '</paints>'
  } >paints.xml
  front="--camera 0,0,4,0,0,0,30 --size 90x60 --samples 1"
}

# pixel FILE X Y: its channels, separated by blanks.
pixel() { oiiotool "$1" --cut "1x1+$2+$3" --printstats 2>/dev/null | sed -nE 's/.*Stats Avg: +(.*) \(float\)/\1/p' | tr -s ' '; }

# near "A B C ..." "D E F ...": whether the numbers agree within 1e-3.
near() {
  awk -v a="$1" -v b="$2" 'BEGIN { n = split(b, y, " "); split(a, x, " ")
    for (i = 1; i <= n; ++i) if ((x[i] - y[i])^2 > 1e-6) exit 1 }' && return 0
  echo "$1 is not $2"
  return 1
}

@test "parts wear their paints, by part, by material, and the rest by --paint" {
  run render-osmesa --mesh panels.obj --light 0,0 $front -p paints.xml#white --part lacquer=paints.xml#green \
    --part right=paints.xml#red -o out.exr --report r.json
  [ "$status" -eq 0 ]
  near "$(pixel out.exr 22 30)" "0.1 0.8 0.1 1"
  near "$(pixel out.exr 45 30)" "1 1 1 1"
  near "$(pixel out.exr 67 30)" "0.8 0.1 0.1 1"
  grep -q '"paint": "green"' r.json
}

@test "the part's own name goes before its material, whatever the order" {
  render-osmesa -q --mesh panels.obj --light 0,0 $front --part right=paints.xml#red --part lacquer=paints.xml#green -o a.exr
  render-osmesa -q --mesh panels.obj --light 0,0 $front --part lacquer=paints.xml#green --part right=paints.xml#red -o b.exr
  near "$(pixel a.exr 67 30)" "0.8 0.1 0.1 1"
  near "$(pixel b.exr 67 30)" "0.8 0.1 0.1 1"
}

@test "parts without a paint are gray, which is told once" {
  run render-osmesa --mesh panels.obj --light 0,0 $front -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "3 of 3 parts have no paint and are matt gray: left, middle, right: give --paint or --part" ]]
  [ "$(grep -c 'warning' <<<"$output")" -eq 1 ]
}

@test "the EXR says what made it, and in which space it is" {
  render-osmesa -q --mesh panels.obj --light 0,0 $front --part left=paints.xml#red -o out.exr
  header=$(exrheader out.exr)
  [[ "$header" =~ "render-osmesa" ]]
  [[ "$header" =~ "--light 0,0" ]]
  [[ "$header" =~ "lin_rec2020_scene" ]]
  [[ "$header" =~ chromaticities ]]
}

@test "buffers go into the same EXR, with the names of the parts" {
  render-osmesa -q --mesh panels.obj --light 0,45 $front --aov normal,aspecular,lambert --aov mask,part -o out.exr
  header=$(exrheader out.exr)
  for channel in normal.X normal.Y normal.Z aspecular lambert mask part; do [[ "$header" =~ $channel ]]; done
  [[ "$header" =~ '["left","middle","right"]' ]]
  oiiotool out.exr --ch part --cut 1x1+67+30 --printstats | grep -q 'Stats Avg: 3'
  oiiotool out.exr --ch aspecular --cut 1x1+45+30 --printstats | grep -qE 'Stats Avg: (45|44.9)'
}

@test "a PNG is what --view says, and needs no --exposure" {
  render-osmesa -q --mesh "$shape" $light $small -o shape.png
  file shape.png | grep -q 'PNG image data, 96 x 54, 8-bit/color RGB'
  render-osmesa -q --mesh "$shape" $light $small --view 'aces sdr' -o aces.png
  ! cmp -s shape.png aces.png || false
  run render-osmesa --mesh "$shape" $light $small --view filmic -o no.png
  [ "$status" -eq 2 ]
  [[ "$output" =~ 'there are "Paint", "Un-tone-mapped", "ACES SDR"' ]]
  [ ! -e no.png ]
}

@test "--gbuffer shades the buffers again, bit for bit, without the mesh" {
  world="--light 10,30 --part lacquer=paints.xml#green --part right=paints.xml#red"
  render-osmesa -q --mesh panels.obj $front $world --engine cpu --aov normal,part -o direct.exr
  render-osmesa -q --gbuffer direct.exr $world --aov normal,part -o again.exr --report r.json
  oiiotool direct.exr again.exr --diff >/dev/null
  grep -q '"opengl": null' r.json
  [[ "$(exrheader again.exr)" =~ '["lacquer","glass","lacquer"]' ]]
  render-osmesa -q --gbuffer direct.exr --light 0,0 -p paints.xml#white -o other.exr
  near "$(pixel other.exr 45 30)" "1 1 1 1"
  render-osmesa -q --gbuffer direct.exr --light 0,0 --light-sweep 2 -o sweep.exr
  [ -e sweep-0002.exr ]
  rm -f out.exr
  refused 2 'there is nothing to draw: give --mesh, or --gbuffer' $light
  for both in "--mesh panels.obj" "--size 32x32" "--camera 0,0,4,0,0,0" "--camera 0,0" "--turntable 2" "--texture a=b.exr"; do
    run render-osmesa --gbuffer direct.exr $light $both -o out.exr
    [ "$status" -eq 2 ]
    [[ "$output" =~ "--gbuffer and ${both%% *} exclude each other" ]]
  done
  run render-osmesa --gbuffer direct.exr $light --samples 4 -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--samples is 4: --gbuffer holds pixel centers" ]]
  run render-osmesa --gbuffer direct.exr $light --engine gl -o out.exr
  [ "$status" -eq 2 ]
  render-osmesa -q --mesh panels.obj $front $world -o plain.exr
  run render-osmesa --gbuffer plain.exr $light -o out.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'has no channel "normal.X": make the buffers by render-osmesa' ]]
  run render-osmesa --gbuffer nowhere.exr $light -o out.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "nowhere.exr" ]]
  [ ! -e out.exr ]
}

@test "an EXR goes to standard output" {
  render-osmesa --mesh panels.obj --light 0,0 $front -o - 2>messages >out.exr
  near "$(pixel out.exr 45 30)" "0.18 0.18 0.18 1"
  grep -q 'standard output' messages
}

@test "HardCase threads: the same bytes for any number" {
  for threads in 1 2 7; do
    LP_NUM_THREADS=$threads render-osmesa -q --mesh "$shape" $light $small --aov normal,part -o out.exr
    mv out.exr $threads.exr
  done
  cmp 1.exr 2.exr
  cmp 1.exr 7.exr
  for threads in 1 7; do
    render-osmesa -q --threads $threads --mesh "$shape" $light $small --aov normal,part -o out.exr
    oiiotool out.exr 1.exr --diff >/dev/null
  done
}

@test "--check agrees with the reference integrator where nothing is approximated" {
  run render-osmesa --mesh panels.obj --light 20,30 --light -1,1,1,0.5,0.5,0.2 -p paints.xml#red $front --effects all,-rays --check 100 -o out.exr --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ "dE00 to the reference: mean 0.00, p95 0.00 (0.00 to 0.00), max 0.00" ]]
  grep -q '"checked_pixels": 100' r.json
}

@test "--seed chooses the checked pixels" {
  for seed in 1 1 2; do
    render-osmesa -q --mesh "$shape" $light $small --check 3 --seed $seed -o out.exr --report r.json
    sed -n '/"error": {/,/}/p' r.json | grep -E '"(worst_x|worst_y|de00_max)"' >>"seed-$seed.txt"
  done
  [ "$(wc -l <seed-2.txt)" -eq 3 ]
  [ "$(head -3 seed-1.txt)" = "$(tail -3 seed-1.txt)" ]
  [ "$(head -3 seed-1.txt)" != "$(cat seed-2.txt)" ]
}

@test "a camera inside the mesh, or looking elsewhere, is told" {
  run render-osmesa --mesh "$shape" $light $small --camera 0,0,0.01 -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "the camera is inside the mesh" ]]
  run render-osmesa --mesh panels.obj $light $small --camera 0,0,4,0,0,9 -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "the mesh is not in the picture" ]]
}

# refused STATUS TEXT ARGUMENT...: exit status, message, and no file.
refused() {
  local status_wanted=$1 text=$2
  shift 2
  run render-osmesa --size 32x32 -o out.exr "$@"
  [ "$status" -eq "$status_wanted" ] && [[ "$output" == *"$text"* ]] && [ ! -e out.exr ] && return 0
  echo "status $status: $output"
  return 1
}

@test "mistakes in part and paint names are answered with what there is" {
  refused 2 'no part or material "midle": did you mean "middle"? its parts are left, middle, right; its materials are lacquer, glass' \
    --mesh panels.obj $light --part midle=paints.xml#red
  refused 3 'holds no paint "rde": did you mean "red"? it holds red, green, white, bare' --mesh panels.obj $light -p paints.xml#rde
  refused 2 'paints.xml#*e* means 4 paints, and one is wanted: write paints.xml#NAME for one of them: red, green' \
    --mesh panels.obj $light --part 'middle=paints.xml#*e*'
  render-osmesa -q --size 32x32 --mesh panels.obj $light -p paints.xml#red --part 'middle=paints.xml#gr*' -o one.exr
  refused 2 'holds 4 paints: write paints.xml#NAME' --mesh panels.obj $light -p paints.xml
  refused 2 'write PART=FILE.xml#PAINT' --mesh panels.obj $light --part paints.xml
  refused 3 'nowhere.xml' --mesh panels.obj $light -p nowhere.xml#red
}

@test "a file with a # in its own name is meant as it stands" {
  sed '/name="green"/d; /name="white"/d; /name="bare"/d' paints.xml >'coat#7.xml'
  render-osmesa -q --mesh panels.obj $light --size 32x32 -p 'coat#7.xml' -o a.exr
  render-osmesa -q --mesh panels.obj $light --size 32x32 -p 'coat#7.xml#red' -o b.exr
  oiiotool --hash a.exr b.exr | sed -n 's/.*SHA-1: //p' | uniq -c | grep -q '^ *2 '
}

@test "mistakes in the other options name the option, the value and what it takes" {
  refused 2 'there is no light: give --env, --light or both' --mesh panels.obj
  refused 2 '--light is "30": write AZ,EL or X,Y,Z' --mesh panels.obj --light 30
  refused 2 '--light is "0,0,0": the vector to the light has no length' --mesh panels.obj --light 0,0,0
  refused 2 '--light is "0,0,1,-1,1,1": light cannot be negative' --mesh panels.obj --light 0,0,1,-1,1,1
  refused 2 '--samples is 8: give 1, 4 or 16' --mesh panels.obj $light --samples 8
  refused 2 '--camera has the elevation 95' --mesh panels.obj $light --camera 0,95
  refused 2 '--camera has 5 numbers' --mesh panels.obj $light --camera 1,2,3,4,5
  refused 2 "eye and target are the same point" --mesh panels.obj $light --camera 1,2,3,1,2,3
  refused 2 '--background is "blue": write none, env or R,G,B' --mesh panels.obj $light --background blue
  refused 2 '--background env needs --env' --mesh panels.obj $light --background env
  refused 2 '--exposure is "bright": write a number of stops, or auto' --mesh panels.obj $light --exposure bright
  refused 2 'no buffer "depth": there are normal, aspecular, lambert, mask, part' --mesh panels.obj $light --aov depth
  refused 2 '--view is for a PNG' --mesh panels.obj $light --view Paint
  refused 3 'nowhere.obj' --mesh nowhere.obj $light
  refused 3 'nowhere.env.exr' --mesh panels.obj --env nowhere.env.exr
  run render-osmesa --mesh panels.obj $light --size 32 -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ '--size is "32": write WIDTHxHEIGHT in pixels' ]]
  run render-osmesa --mesh panels.obj $light -o out.jpg
  [ "$status" -eq 2 ]
  [[ "$output" =~ 'write a name that ends in .exr or .png' ]]
  run render-osmesa --mesh panels.obj $light -o out.png --aov mask
  [ "$status" -eq 2 ]
}

@test "a writing error is an error, and says so" {
  run render-osmesa --mesh panels.obj $light $small -o /nowhere/out.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "/nowhere/out.exr" ]]
}

@test "--explain prints parts, effects and the engine; --print-shader the program" {
  run render-osmesa --mesh panels.obj --light 0,0 $front -p paints.xml#red --explain --print-shader -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "3 parts" ]]
  [[ "$output" =~ effect\ +needed ]]
  [[ "$output" =~ "solid paints: no flake lobes" ]]
  [[ "$output" =~ "engine cpu: prefiltered maps, and rays where" ]]
  [[ "$output" =~ "#version 330 core" ]]
  [[ ! "$output" =~ "what this program lacks" ]]
  # The plan has found what the view shows, and the report tells how long that took.
  render-osmesa -q --mesh panels.obj --light 0,0 $front -p paints.xml#red --report r.json -o out.exr
  jq -e '.results.gbuffer_ms > 0' r.json
}

@test "the plan is in the report and in the header" {
  render-osmesa -q --mesh panels.obj --light 0,0 $front -p paints.xml#red --report r.json -o out.exr
  for key in '"effect": "fresnel"' '"needed": false' '"decision": "not in the scene"' '"engine": "cpu"' '"plan_ms"'; do
    grep -q "$key" r.json
  done
  [[ "$(exrheader out.exr)" =~ goniochrome:plan ]]
}

@test "--effects and --engine choose, and gl and cpu draw the same" {
  render-osmesa -q --mesh "$shape" $light $small --engine gl -o gl.exr --report r.json
  grep -q '"engine": "gl"' r.json
  render-osmesa -q --mesh "$shape" $light $small --engine cpu -o cpu.exr
  oiiotool gl.exr cpu.exr --fail 0.001 --diff >/dev/null
  render-osmesa -q --mesh "$shape" $light --size 96x54 --samples 1 --effects none -o none.exr
  [ "$(pixel none.exr 48 27)" = "0.000000 0.000000 0.000000 1.000000" ] || near "$(pixel none.exr 48 27)" "0 0 0 1"
  refused 2 '--effects is "fast": write auto, all or none' --mesh "$shape" $light --effects fast
  refused 2 '--effects names "shine": there are diffuse' --mesh "$shape" $light --effects all,-shine
  refused 2 'engine' --mesh "$shape" $light --engine vulkan
  refused 2 'tolerance' --mesh "$shape" $light --tolerance -1
}

# A highlight is all that such a picture shows, and lies between the points of a plan.
@test "a paint of gloss alone under a lamp is not drawn black" {
  cat >gloss.xml <<'XML'
<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="gloss"><lobes space="lin_rec2020_scene" basis="none" method="l1" max_de00="0" mean_de00="0"><diffuse r="0" g="0" b="0"/><lobe exponent="250" ddr="0" ddg="0" ddb="0" gr="0.3" gg="0" gb="0"/></lobes></paint></paints>
XML
  for effects in auto all; do
    render-osmesa -q --mesh "$shape" -p gloss.xml --light 35,40@0 --size 96x54 --samples 1 --effects $effects,-rays -o $effects.exr
  done
  oiiotool auto.exr all.exr --fail 1e-5 --diff
  oiiotool --stats all.exr | awk '/Stats Max/ { exit !($3 > 1e-4) }'
}

@test "options that are gone name what to use instead" {
  refused 2 '--budget is gone: what lobes and look-ups may leave out is said by --tolerance' --mesh "$shape" $light --budget 5
  refused 2 '--orbit is gone: give the same numbers to --camera' --mesh "$shape" $light --orbit 30,20
  refused 2 '--fov is gone: write it behind the camera' --mesh "$shape" $light --fov 20
  refused 2 '--eye-height is gone: write it behind the floor' --mesh "$shape" $light --eye-height 1.5
  refused 2 '--gpu is gone: give --engine gpu' --mesh "$shape" $light --gpu
  refused 2 '--check-against is gone: write it behind the number of pixels' --mesh "$shape" $light --check-against truth
  refused 2 '--budget is gone' --mesh "$shape" $light --budget=5
  refused 2 '--budget is gone' --mesh "$shape" $light --budget
}

@test "--operator: red paint in cyan light keeps some red" {
  red="--mesh panels.obj -p paints.xml#red $front --light 0,0,0,1,1 --effects all"
  render-osmesa -q $red --operator none -o none.exr
  near "$(pixel none.exr 45 30)" "0 0.1 0.1 1"
  render-osmesa -q $red --operator iso -o iso.exr
  awk -v p="$(pixel iso.exr 45 30)" 'BEGIN { split(p, c, " "); exit !(c[1] > 0.1) }'
  render-osmesa -q $red --operator iso,0 -o plain.exr
  near "$(pixel plain.exr 45 30)" "0 0.1 0.1 1"
  render-osmesa -q $red --operator iso,0,1,1 -o blue.exr # red takes nothing
  awk -v p="$(pixel blue.exr 45 30)" 'BEGIN { split(p, c, " "); exit !(c[1] == 0 && (c[2] > 0.11 || c[3] > 0.11 || c[2] < 0.09)) }'
  render-osmesa -q $red --operator rec2020 -o rec2020.exr
  run cmp -s iso.exr rec2020.exr
  [ "$status" -eq 1 ]
  refused 2 '--operator is "xyz": write fitted, plain, iso, iso709, estimated or a JSON file' --mesh panels.obj $light --operator xyz
  refused 2 '--operator is "iso,2"' --mesh panels.obj $light --operator iso,2
  refused 2 '--operator is "iso,0,1"' --mesh panels.obj $light --operator iso,0,1
  refused 2 'red of this operator keeps 1.000 of itself' --mesh panels.obj $light --operator plain,0.1
  # Every other one has shares, in the primaries of its table: all of blue comes from the other channels.
  for name in fitted iso iso709 estimated; do
    render-osmesa -q $red --operator $name,0,0,1 -o shared.exr
    render-osmesa -q $red --operator $name -o bare.exr
    [ "$(pixel shared.exr 45 30)" != "$(pixel bare.exr 45 30)" ]
  done
  # A file holds a table, and the primaries for which it was made.
  k='[[[1,0,0],[0,0,0],[0,0,0]],[[0,0,0],[0,1,0],[0,0,0]],[[0,0,0],[0,0,0],[0,0,1]]]'
  echo "{\"k\": $k}" >plain.json
  render-osmesa -q $red --operator plain.json -o file.exr
  near "$(pixel file.exr 45 30)" "0 0.1 0.1 1"
  echo "{\"k\": $k, \"primaries\": \"rec709\"}" >plain709.json
  render-osmesa -q $red --operator plain709.json -o file709.exr
  run near "$(pixel file709.exr 45 30)" "0 0.1 0.1 1"
  [ "$status" -ne 0 ]
  refused 3 'nowhere.json' --mesh panels.obj $light --operator nowhere.json
  # fitted is what is taken without the option, and red is above 0 in it.
  render-osmesa -q $red -o default.exr
  awk -v p="$(pixel default.exr 45 30)" 'BEGIN { split(p, c, " "); exit !(c[1] > 0.03 && c[2] > 0 && c[3] > 0) }'
  render-osmesa -q $red --operator fitted -o fitted.exr
  [ "$(pixel default.exr 45 30)" = "$(pixel fitted.exr 45 30)" ]
}

@test "--split draws two paints side by side" {
  render-osmesa -q --mesh panels.obj --light 0,0 $front --split paints.xml#red,paints.xml#green -o out.exr
  near "$(pixel out.exr 22 30)" "0.8 0.1 0.1 1"
  near "$(pixel out.exr 67 30)" "0.1 0.8 0.1 1"
  rm out.exr
  refused 2 '--split names 1 paints: write two' --mesh panels.obj $light --split paints.xml#red
  refused 2 '--split and --check exclude each other' --mesh panels.obj $light --split paints.xml#red,paints.xml#green --check 5
}

@test "--turntable and --light-sweep write sequences" {
  render-osmesa -q --mesh panels.obj -p paints.xml#red --light 0,0 $front --turntable 4 -o turn.exr --report r.json
  grep -q '"frames": 4' r.json
  [ "$(ls turn-*.exr | wc -l)" -eq 4 ]
  near "$(pixel turn-0001.exr 45 30)" "0.8 0.1 0.1 1"
  near "$(pixel turn-0003.exr 45 30)" "0 0 0 1"
  render-osmesa -q --mesh panels.obj -p paints.xml#red --light 0,0 $front --light-sweep 4 -o sweep.png
  [ -e sweep-0004.png ]
  run cmp sweep-0001.png sweep-0003.png
  [ "$status" -eq 1 ]
  refused 2 '--turntable and --light-sweep exclude each other' --mesh panels.obj $light --turntable 2 --light-sweep 2
  run render-osmesa --mesh panels.obj $light --turntable 2 -o -
  [ "$status" -eq 2 ]
  [[ "$output" =~ "give --output a name" ]]
  run render-osmesa --mesh panels.obj --env nowhere.env.exr --light-sweep 2 -o out.exr
  [ "$status" -ne 0 ]
}

@test "a lamp has an extent, and a wrong one is refused" {
  for extent in @0 "" @3; do
    render-osmesa -q --mesh "$TESTDATA/box.obj" --paint paints.xml#red --light 0,20,1,1,1$extent --size 64x40 --samples 1 --aov mask -o lamp.exr
    exrheader lamp.exr | grep -A1 'goniochrome:lights' | grep -q ",1,1,1,$(case $extent in @*) echo "${extent#@}" ;; *) echo 0.53 ;; esac)"
  done
  for wrong in 0,20@ 0,20@-1 0,20@181 0,20@wide place:1,2 place:1,2,3,4 @3; do
    run --separate-stderr render-osmesa --mesh "$TESTDATA/box.obj" --paint paints.xml#red --light "$wrong" --size 64x40 -o lamp.exr
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"--light is \"$wrong\""* ]]
  done
}

@test "a lamp at a place is drawn along rays" {
  for place in 0,40,0 0,80,0; do
    render-osmesa -q --mesh "$TESTDATA/box.obj" --paint paints.xml#red --light "place:$place@1" --size 64x40 --samples 1 --report r.json -o lamp.exr
    [ "$(jq -r .results.engine r.json)" = path ]
  done
}

@test "a lamp at a place is drawn by prefiltered maps where it is a point or lights a texture" {
  view="--mesh panels.obj --size 64x40 --samples 1"
  wood="$TESTDATA/wood.sbrdf.exr"
  render-osmesa -q $view --paint paints.xml#red --light place:0,1,1@0 --engine cpu --report r.json -o paint.exr
  [ "$(jq -r .results.engine r.json)" = cpu ]
  render-osmesa -q $view --texture left="$wood" --texture middle="$wood" --texture right="$wood" \
    --light place:0,1,1@3 --engine cpu -o wood.exr
  run --separate-stderr render-osmesa $view --paint paints.xml#red --light place:0,1,1@3 --engine cpu -o none.exr
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"draws a lamp at a place that shines on paint as a point: write @0"* ]]
  render-osmesa -q $view --paint paints.xml#red --light 0,1,1@0 --engine cpu -o far.exr
  run cmp paint.exr far.exr
  [ "$status" -eq 1 ]
  for engine in gl integral; do
    run --separate-stderr render-osmesa $view --paint paints.xml#red --light place:0,1,1@0 --engine $engine -o none.exr
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"take cpu or path"* ]]
  done
}

@test "words of effects that are gone name what to write instead" {
  for word in spots:horizon anisotropy:brushed stretch:satin tilts-2:travel texture-lobes:texture self:rays bounce:--bounces \
    floor:'--floor none' panes:PART=glass extent:@0; do
    refused 2 "--effects names \"${word%%:*}\", which is gone" --mesh "$shape" $light --effects "auto,-${word%%:*}"
    [[ "$output" == *"${word#*:}"* ]]
  done
}

@test "cameras and checks that cannot be are refused, and numbers of a camera say which it is" {
  refused 2 'field of view 151' --mesh "$shape" $light --camera 35,12,1,151
  refused 2 '--camera has 1 numbers' --mesh "$shape" $light --camera 35
  refused 2 '--check is "ten"' --mesh "$shape" $light --check ten
  refused 2 '--check is "10,truths"' --mesh "$shape" $light --check 10,truths
  refused 2 'eye= goes behind shadow' --mesh "$shape" $light --floor none,eye=2
  # 30 degrees are the field of view where none is said.
  render-osmesa -q --mesh "$shape" $light $small --camera 40,15 -o usual.exr
  render-osmesa -q --mesh "$shape" $light $small --camera 40,15,1,30 -o told.exr
  render-osmesa -q --mesh "$shape" $light $small --camera 40,15,1,60 -o wide.exr
  oiiotool usual.exr told.exr --diff
  ! oiiotool usual.exr wide.exr --diff || false
}
