# The engine path from the outside: bounces, limits, floors, parts that shine, noise, and what it refuses.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/outdoor.exr" --resize:filter=box 64x32 -o sky.exr
  oiiotool --create 32x16 3 --fill:color=1,1,1 32x16 -o even.exr
  prefilter-envmap -q sky.exr --basis "$TESTDATA/b5.basis.xml" --size 16 -o sky.env.exr
  prefilter-envmap -q even.exr --basis "$TESTDATA/b5.basis.xml" --size 8 -o even.env.exr
  # A slab of 2 x 2, 1 above the ground, on a post; the lamp is a square over it that looks down, and the dot has no area.
  cat >table.obj <<'OBJ'
v -1 1 -1
v -1 1 1
v 1 1 1
v 1 1 -1
v -.1 0 -.1
v -.1 0 .1
v .1 0 .1
v .1 0 -.1
v -.5 3 -.5
v .5 3 -.5
v .5 3 .5
v -.5 3 .5
o Slab
f 1 2 3 4
o Foot
f 5 6 7 8
o Lamp
f 9 10 11 12
OBJ
  matt() { # NAME REFLECTANCE
    awk -v n="$1" -v r="$2" 'BEGIN { r /= atan2(0, -1)
      printf "<paint name=\"%s\"><lobes space=\"lin_rec2020_scene\" basis=\"none\" method=\"l1\" max_de00=\"0\" mean_de00=\"0\">", n
      printf "<diffuse r=\"%.9g\" g=\"%.9g\" b=\"%.9g\"/></lobes></paint>\n", r, r, r }'
  }
  {
    echo '<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
    matt gray 0.5
    matt white 1
    matt beyond 1.3
    matt black 0
    echo '</paints>'
  } >paints.xml
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  table="--mesh table.obj --paint paints.xml#gray --camera 5,3,6,0,0.6,0,30 --size 64x48 --samples 1"
}

# pixel FILE X Y: its channels, separated by blanks.
pixel() { oiiotool "$1" --cut "1x1+$2+$3" --printstats 2>/dev/null | sed -nE 's/.*Stats Avg: +(.*) \(float\)/\1/p' | tr -s ' '; }
# mean FILE: the mean of its channels.
mean() { oiiotool "$1" --printstats | sed -nE 's/.*Stats Avg: +(.*) \(float\)/\1/p' | tr -s ' '; }
# result KEY: of r.json.
result() { python3 -c 'import json, sys; print(eval("r" + sys.argv[1], {"r": json.load(open("r.json"))["results"]}))' "$1"; }
# holds EXPRESSION
holds() { awk "BEGIN { exit !($1) }" || { echo "not so: $1"; return 1; }; }
refused() { # STATUS TEXT ARGUMENTS...
  local status_wanted=$1 text=$2
  shift 2
  run --separate-stderr render-osmesa "$@" -o refused.exr
  [ "$status" -eq "$status_wanted" ] && [[ "$stderr" == *"$text"* ]] && [ ! -e refused.exr ] && return 0
  echo "status $status, not $status_wanted; $stderr"
  return 1
}

@test "paths that nobody asked for by name are smoothed, and end by themselves" {
  local floor="$table --env sky.env.exr --floor paints.xml#gray"
  render-osmesa -q $floor --report r.json -o a.exr
  [ "$(result "['engine']")" = path ]
  [ "$(result "['plan_quick']")" = True ]
  render-osmesa -q $floor --tolerance 1 --report r.json -o a.exr
  [ "$(result "['noise_reached']")" = True ]
  local smooth=$(result "['samples_mean']")
  render-osmesa -q $floor --tolerance 1 --engine path --report r.json -o b.exr
  [ "$(result "['plan_quick']")" = False ]
  holds "$(result "['samples_mean']") > 1.3 * $smooth"
}

@test "a time limit is kept with smoothed paths, whose errors have all pixels" {
  render-osmesa -q --mesh table.obj --paint paints.xml#gray --env sky.env.exr --floor paints.xml#gray --time-limit 0.01 \
    --aov error --report r.json -o a.exr
  [ "$(result "['enlarged_from']['width']")" = 160 ]
  oiiotool a.exr --ch error --printstats | grep -q 'Stats Max: [0-9.]*[1-9]'
}

@test "the noise is within the tolerance, and the report and the EXR tell it" {
  render-osmesa -q $table --env sky.env.exr --engine path --tolerance 1 --aov error,part --report r.json -o a.exr
  [ "$(result "['engine']")" = path ]
  [ "$(result "['opengl']")" = None ]
  [ "$(result "['noise_reached']")" = True ]
  [ "$(result "['bounces']")" = 4 ]
  holds "$(result "['noise_de00_p95']") <= 1 && $(result "['samples_mean']") >= 32"
  oiiotool a.exr --ch error --printstats | grep -q 'Stats Max: [0-9.]*[1-9]'
  render-osmesa -q $table --env sky.env.exr --engine path --tolerance 1 --threads 1 -o b.exr
  render-osmesa -q $table --env sky.env.exr --engine path --tolerance 1 --threads 3 -o c.exr
  oiiotool b.exr c.exr --diff >/dev/null
  render-osmesa -q $table --env sky.env.exr --engine path --tolerance 1 --seed 2 -o d.exr
  ! oiiotool b.exr d.exr --diff >/dev/null 2>&1 || false
}

@test "a time limit ends it with status 4 and the best picture so far" {
  run --separate-stderr render-osmesa $table --env sky.env.exr --engine path --tolerance 0.001 --time-limit 0.5 --report r.json -o a.exr
  [ "$status" -eq 4 ]
  [[ "$stderr" == *'stopped before it was within 0.001'* ]]
  [ "$(result "['noise_reached']")" = False ]
  read -r r _ <<<"$(pixel a.exr 32 22)"
  holds "$r > 0"
}

@test "bounces light the underside" {
  below="--mesh table.obj --paint paints.xml#white --camera 4,0.3,4,0,0.9,0,30 --size 40x40 --samples 1"
  for n in 0 1 8; do
    render-osmesa -q $below --env even.env.exr --floor paints.xml#white,-1 --bounces $n --tolerance 1 -o $n.exr
  done
  # The mean of 27 pixels: a single one is off by the noise of 1 dE00, which is 5 % of white.
  for n in 0 1 8; do oiiotool $n.exr --cut 9x3+16+17 -o patch$n.exr; done
  read -r none _ <<<"$(mean patch0.exr)"
  read -r once _ <<<"$(mean patch1.exr)"
  read -r many _ <<<"$(mean patch8.exr)"
  holds "$none < 0.7 * $once && $once < $many && $many < 1.02"
}

@test "the floor shows the ground, darker below the slab; none and a paint do as they say" {
  scene="--mesh table.obj --paint paints.xml#gray --camera 6,4,6,0,0,0,40 --size 64x48 --samples 4 --env even.env.exr --engine path --tolerance 0.7"
  render-osmesa -q $scene --background env -o shadow.exr
  render-osmesa -q $scene --background env --floor none -o none.exr
  render-osmesa -q $scene --floor paints.xml#black -o black.exr
  render-osmesa -q $scene --floor shadow,-3,eye=4 -o deep.exr
  read -r far _ <<<"$(pixel shadow.exr 5 40)"
  read -r near _ <<<"$(pixel shadow.exr 33 29)"
  holds "$far > 0.97 && $far < 1.01 && $near < 0.95"
  [ "$(pixel none.exr 5 40)" = "$(pixel none.exr 60 40)" ]
  read -r dark _ _ alpha <<<"$(pixel black.exr 5 40)"
  holds "$dark == 0 && $alpha == 1"
  ! oiiotool shadow.exr deep.exr --diff >/dev/null 2>&1 || false
}

@test "a lamp is all the light there is, and auto takes the engine for it" {
  render-osmesa -q $table --emit Lamp=20,18,15 --tolerance 2 --report r.json -o lamp.png
  [ "$(result "['engine']")" = path ]
  holds "$(result "['exposure_stops']") < 0 || $(result "['exposure_stops']") > 0"
  render-osmesa -q $table --emit Lamp=20,18,15 --tolerance 2 -o lamp.exr
  read -r r g b _ <<<"$(pixel lamp.exr 32 20)"
  holds "$r > 0 && $r > $g && $g > $b"
}

@test "the card under the light is exposed to middle gray" {
  # The slab of 18 % seen from above in even light: linear .18 after exposure, whatever the light's strength.
  matt='<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="card"><lobes space="lin_rec2020_scene" basis="none" method="l1" max_de00="0" mean_de00="0"><diffuse r="0.0572958" g="0.0572958" b="0.0572958"/></lobes></paint></paints>'
  echo "$matt" >card.xml
  for white in 1 5; do
    render-osmesa -q --mesh table.obj --paint card.xml --camera 0,6,0.01,0,0,0,20 --size 32x32 --samples 1 \
      --light "0,90,$white,$white,$white" --view un-tone-mapped -o card.png
      # .18 is .4614 in sRGB's curve, and steps are 1/255.
    read -r r _ <<<"$(oiiotool card.png --cut 1x1+16+8 --printstats | sed -nE 's/.*Stats Avg: +(.*) \(.*/\1/p' | tr -s ' ')"
    holds "$r > 0.457 && $r < 0.466"
  done
}

@test "no prefiltered lobe is needed" {
  prefilter-envmap -q sky.exr --exponents 3 --size 8 -o bare.env.exr
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  render-osmesa -q --mesh table.obj --paint fitted.xml#candy_red --camera 5,3,6,0,0.6,0,30 --size 32x24 --samples 1 \
    --env bare.env.exr --engine path --tolerance 2 -o a.exr
  [ -s a.exr ]
}

@test "odd scenes are told" {
  run --separate-stderr render-osmesa $table --env even.env.exr --engine path --tolerance 2 --floor shadow,0.5 -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'the floor at height 0.5 lies above the lowest point of the mesh, which is at 0'* ]]
  run --separate-stderr render-osmesa $table --part Foot=paints.xml#beyond --env even.env.exr --engine path --tolerance 2 -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'the paint of Foot sends back more light than it gets'* ]]
  run --separate-stderr render-osmesa --mesh table.obj --paint paints.xml#gray --camera 0,9,0.1,0,0,0,30 --size 64x48 --samples 1 \
    --env even.env.exr --engine path --tolerance 2 -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'Lamp shows its back alone: its faces may be turned inside out'* ]]
  run --separate-stderr render-osmesa --mesh table.obj --paint paints.xml#gray --camera 5,-3,6,0,0.6,0,30 --size 32x24 --samples 1 \
    --env even.env.exr --engine path --tolerance 2 --floor shadow -o a.exr
  [[ "$stderr" == *'is below the floor'* ]]
}

@test "a sun of 1e8, a single triangle and flat parts are drawn or refused by name" {
  oiiotool --create 64x32 3 --fill:color=.2,.2,.2 64x32 --fill:color=1e8,1e8,1e8 1x1+30+6 -o sun.exr
  prefilter-envmap -q sun.exr --exponents 3 --size 8 -o sun.env.exr
  render-osmesa -q $table --env sun.env.exr --background env --engine path --time-limit 5 --report r.json -o a.exr || [ $? -eq 4 ]
  [[ "$(result "['noise_de00_p95']")" =~ ^[0-9.e-]+$ ]]
  ! mean a.exr | grep -qiE 'nan|inf' || false
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one.obj
  render-osmesa -q --mesh one.obj --paint paints.xml#gray --env even.env.exr --engine path --size 32x24 --samples 4 --background env --tolerance 2 -o a.exr
  sed 's/^v 1 1 1$/v nan 1 1/' table.obj >nan.obj
  refused 3 'nan.obj' --mesh nan.obj --paint paints.xml#gray --env even.env.exr --engine path --size 32x24
  printf 'v 5 5 5\nv 6 5 5\no Dot\nf 13 14 13\n' | cat table.obj - >dot.obj
  refused 3 'the part "Dot" has no area' --mesh dot.obj --paint paints.xml#gray --emit Dot=1,1,1 --size 32x24
}

@test "what does not go together is refused" {
  refused 2 '--engine cpu draws neither parts that shine nor floors that wear a paint' $table --env even.env.exr --engine cpu --floor paints.xml#gray
  refused 2 '--engine gl draws neither parts that shine nor' $table --env even.env.exr --engine gl --emit Lamp=1,1,1
  refused 2 '--emit is "Lamp=1,1": write PART=R,G,B' $table --emit Lamp=1,1
  refused 2 '--emit is "Lamp=1,-1,1": light cannot be negative' $table --emit Lamp=1,-1,1
  refused 2 'the mesh has no part or material "Bulb"' $table --emit Bulb=1,1,1
  refused 2 '--floor is "shadow,low"' $table --env even.env.exr --floor shadow,low
  refused 2 '--floor is "none,1"' $table --env even.env.exr --floor none,1
  refused 3 'carpet.xml' $table --env even.env.exr --floor carpet.xml#red
  refused 2 '--floor shadow shows the ground of an environment: give --env' $table --light 0,45 --floor shadow
  refused 2 '--aov error is of pictures by samples: take --engine path' $table --env even.env.exr --aov error
  refused 2 'draws a mesh: --gbuffer is shaded by' --gbuffer x.exr --env even.env.exr --engine path
  refused 2 '--bounces' $table --env even.env.exr --engine path --bounces -1
}
