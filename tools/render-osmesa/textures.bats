#!/usr/bin/env bats
# How --texture lays maps on meshes, with and without texture coordinates.

setup() {
  cd "$BATS_TEST_TMPDIR"
  # A cube from -1 to 1 without texture coordinates, and a square in z = 0 that has them.
  { for z in -1 1; do for y in -1 1; do for x in -1 1; do echo "v $x $y $z"; done; done; done
    echo "o Cube"
    printf 'f %s\n' "1 3 4 2" "5 6 8 7" "1 2 6 5" "3 7 8 4" "1 5 7 3" "2 4 8 6"; } >cube.obj
  printf 'v %s\n' "-1 -1 0" "1 -1 0" "1 1 0" "-1 1 0" >square.obj
  printf 'vt %s\n' "0 0" "1 0" "1 1" "0 1" >>square.obj
  printf 'o Square\nf 1/1 2/2 3/3 4/4\n' >>square.obj
  # Red at the left, blue at the right, green above both.
  printf 'P6\n2 2\n255\n\0\377\0\0\377\0\377\0\0\0\0\377' >four.ppm
  paint-sbrdf -q four.ppm -o four.sbrdf.exr
  azimuth=0
  lit="--light 0,30@0 --size 32x32 --samples 1 --effects auto,-rays"
}

# texel FILE X Y: the strongest channel of a pixel. The pixels of a file are printed once, because oiiotool starts slowly.
texel() {
  [ "$1.txt" -nt "$1" ] || oiiotool --dumpdata "$1" >"$1.txt"
  awk -v at="($2, $3):" 'sub(/.*Pixel /, "") && index($0, at) == 1 { r = $(NF-3); g = $(NF-2); b = $(NF-1)
    print (r + g + b < 1e-6 ? "none" : r >= g && r >= b ? "red" : g >= b ? "green" : "blue") }' "$1.txt"
}

draw() { # draw NAME MESH TEXTURE: also its report, seen and lit from the azimuth
  # shellcheck disable=SC2086
  render-osmesa -q --mesh "$2" --texture "$3" ${lit/0,30/$azimuth,30} --camera "$azimuth,0,0.9" --report "$1.json" -o "$1.exr"
}

@test "a mesh with texture coordinates uses them, and the report says so" {
  draw uv square.obj Square=four.sbrdf.exr
  [ "$(texel uv.exr 11 19) $(texel uv.exr 20 19) $(texel uv.exr 11 11)" = "red blue green" ]
  jq -e '.results.textures == [{"part":"Square","file":"four.sbrdf.exr","projection":"uv","width":null}]' uv.json
  draw planar square.obj Square=four.sbrdf.exr,project=planar
  [ "$(texel planar.exr 11 19) $(texel planar.exr 20 19) $(texel planar.exr 11 11)" = "red blue green" ]
  jq -e '(.results.textures[0] | [.projection, .width]) == ["planar",2]' planar.json
}

@test "a mesh without texture coordinates gets a box, which is told" {
  # shellcheck disable=SC2086
  run render-osmesa --mesh cube.obj --texture Cube=four.sbrdf.exr $lit --camera 0,0,0.9 --report box.json --explain -o box.exr
  [ "$status" -eq 0 ]
  [[ "$output" == *"Cube has no texture coordinates: its texture is projected by a box"* ]]
  [[ "$output" == *"four.sbrdf.exr on Cube: projected by box, 2 units of the mesh wide"* ]]
  [ "$(texel box.exr 11 19) $(texel box.exr 20 19) $(texel box.exr 11 11)" = "red blue green" ]
  # Every side shows it the right way round.
  for azimuth in 90 180 270; do
    draw side cube.obj Cube=four.sbrdf.exr,project=box
    [ "$(texel side.exr 11 19) $(texel side.exr 20 19) $(texel side.exr 11 11)" = "red blue green" ] || { echo "$azimuth"; false; }
  done
  run render-osmesa --mesh cube.obj --texture Cube=four.sbrdf.exr,project=box $lit -o named.exr
  [[ "$output" != *"has no texture coordinates"* ]]
  run render-osmesa --mesh cube.obj --texture Cube=four.sbrdf.exr,project=uv $lit -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" == *"give project=box"* ]]
  [ ! -e none.exr ]
}

@test "pixels that cover many texels show their mean, whichever engine draws" {
  paint-sbrdf -q four.ppm --tile 8x8 -o many.sbrdf.exr
  floor() { # floor NAME EFFECTS ENGINE
    render-osmesa -q --mesh square.obj --texture 'Square=many.sbrdf.exr*20' --light 0,30@0 --size 48x48 --samples 1 \
      --camera 0,10,1 --effects "$2" --engine "$3" --report "$1.json" -o "$1.exr"
  }
  floor with auto,-rays cpu
  floor without auto,-rays,-texture-filter cpu
  floor gl auto,-rays gl
  jq -e '.results.plan[] | select(.effect == "texture-filter") | .needed and .decision == "drawn" and .de00_p95 > 5' with.json
  jq -e '.results.plan[] | select(.effect == "texture-filter") | .decision == "forced off"' without.json
  spread() { oiiotool "$1.exr" --ch R --cut 16x16+16+16 --printstats | sed -n 's/.*Stats StdDev: *\([0-9.]*\).*/\1/p'; }
  awk -v with="$(spread with)" -v without="$(spread without)" 'BEGIN { exit !(with < 0.2 * without) }'
  oiiotool with.exr gl.exr --fail 0.002 --diff
}

@test "axis, scale, center and turn place it" {
  draw half cube.obj Cube=four.sbrdf.exr,project=planar,axis=z,scale=4,center=1,1,0
  # A texture of four units about the corner: what is seen is its lower left quarter.
  for place in "11 19" "20 19" "20 11"; do [ "$(texel half.exr $place)" = red ] || { echo "$place"; false; }; done
  jq -e '.results.textures[0].width == 4' half.json
  draw turned cube.obj Cube=four.sbrdf.exr,project=planar,axis=z,turn=180
  [ "$(texel turned.exr 20 11) $(texel turned.exr 11 11) $(texel turned.exr 11 19)" = "red blue green" ]
  azimuth=180
  draw behind cube.obj Cube=four.sbrdf.exr,project=planar,axis=z
  [ "$(texel behind.exr 11 19) $(texel behind.exr 20 19)" = "red blue" ]
  draw twice cube.obj 'Cube=four.sbrdf.exr*2,project=planar,axis=z'
  jq -e '.results.textures[0].width == 1' twice.json
}

@test "a decal lies once and on one side" {
  draw decal cube.obj Cube=four.sbrdf.exr,project=decal,axis=z,scale=1
  [ "$(texel decal.exr 14 17) $(texel decal.exr 17 17) $(texel decal.exr 9 21)" = "red blue red" ]
  azimuth=180
  draw behind cube.obj Cube=four.sbrdf.exr,project=decal,axis=z
  [ "$(texel behind.exr 11 19) $(texel behind.exr 20 19) $(texel behind.exr 20 11)" = "red red red" ]
}

@test "a cylinder and a sphere go around the axis" {
  for project in cylinder sphere; do
    draw $project cube.obj Cube=four.sbrdf.exr,project=$project
    [ "$(texel $project.exr 11 22) $(texel $project.exr 20 22) $(texel $project.exr 14 11)" = "red blue green" ] || { echo $project; false; }
    [ "$(jq -r '.results.textures[0].projection' $project.json)" = $project ]
  done
}

@test "a triplanar projection shows a side as a box does, and has no seam" {
  draw box cube.obj Cube=four.sbrdf.exr,project=box
  draw three cube.obj Cube=four.sbrdf.exr,project=triplanar
  oiiotool box.exr three.exr --fail 0.001 --diff
  jq -e '(.results.textures[0] | [.projection, .width]) == ["triplanar",2]' three.json
}

@test "a mixture of maps that are brushed askew looks as the mean of both, in every engine" {
  cp "$TESTDATA/brushed.sbrdf.exr" along.sbrdf.exr
  paint-sbrdf -q along.sbrdf.exr --turn 40 -o askew.sbrdf.exr
  paint-sbrdf -q along.sbrdf.exr askew.sbrdf.exr --mix 0.5 -o both.sbrdf.exr
  oiiotool along.sbrdf.exr askew.sbrdf.exr --add --mulc 0.5 -o averaged.sbrdf.exr
  shown() { # shown NAME ENGINE
    # shellcheck disable=SC2086
    render-osmesa -q --mesh square.obj --texture "Square=$1.sbrdf.exr" $lit --light 40,50@1 --camera 25,35,0.9 \
      --engine "$2" -o shown.exr
    oiiotool shown.exr --ch R,G,B -o "$1-$2.exr"
  }
  for name in along askew both averaged; do shown $name cpu; done
  oiiotool along-cpu.exr askew-cpu.exr --add --mulc 0.5 -o mean.exr
  oiiotool mean.exr both-cpu.exr --fail 2e-4 --diff
  # Averaged parameters are the control.
  run oiiotool mean.exr averaged-cpu.exr --fail 1e-3 --diff
  [ "$status" -ne 0 ]
  for engine in gl integral path; do
    shown both $engine
    oiiotool both-cpu.exr both-$engine.exr --fail 0.002 --diff
  done
}

@test "a map with alpha shows what lies beneath, in every engine and in order" {
  { echo '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="blue"><lobes space="lin_rec2020_scene" basis="b" method="stated" max_de00="0" mean_de00="0">'
    echo '<diffuse r="0.01" g="0.01" b="0.3"/></lobes></paint></paints>'; } >p.xml
  printf 'P6\n1 1\n255\n\377\0\0' >red.ppm
  printf 'P6\n1 1\n255\n\0\377\0' >green.ppm
  paint-sbrdf -q none red.ppm --stripe 0.5,1 --size 2x2 -o red.sbrdf.exr
  paint-sbrdf -q none green.ppm --stripe 0.5,1 --angle 90 --size 2x2 -o green.sbrdf.exr
  for engine in cpu gl integral path; do
    # shellcheck disable=SC2086
    render-osmesa -q --mesh square.obj --paint p.xml --texture Square=red.sbrdf.exr,project=decal,axis=z \
      --texture Square=green.sbrdf.exr,project=decal,axis=z $lit --camera 0,0,0.9 --engine $engine -o $engine.exr
    [ "$(texel $engine.exr 11 11) $(texel $engine.exr 20 11) $(texel $engine.exr 11 20) $(texel $engine.exr 20 20)" = "green red green blue" ] ||
      [ "$(texel $engine.exr 11 11) $(texel $engine.exr 20 11) $(texel $engine.exr 11 20) $(texel $engine.exr 20 20)" = "red green blue green" ] ||
      { echo "$engine: $(texel $engine.exr 11 11) $(texel $engine.exr 20 11) $(texel $engine.exr 11 20) $(texel $engine.exr 20 20)"; false; }
    oiiotool cpu.exr $engine.exr --fail 0.002 --diff
  done
  # The other way round, red lies over green.
  # shellcheck disable=SC2086
  render-osmesa -q --mesh square.obj --paint p.xml --texture Square=green.sbrdf.exr,project=decal,axis=z \
    --texture Square=red.sbrdf.exr,project=decal,axis=z $lit --camera 0,0,0.9 --report r.json -o turned.exr
  [ "$(texel turned.exr 11 11) $(texel turned.exr 20 11)" = "red red" ]
  [ "$(jq -r '.results.parts[0].paint' r.json)" = blue ]
  # The mean texels are seen through as well.
  # shellcheck disable=SC2086
  render-osmesa -q --mesh square.obj --paint p.xml --texture Square=red.sbrdf.exr ${lit/auto/auto,-texture} --camera 0,0,0.9 -o mean.exr
  oiiotool --dumpdata:empty=0 mean.exr | awk '/Pixel \(16, 16\)/ { exit !($(NF-3) > 0.05 && $(NF-1) > 0.05) }'
  run render-osmesa --mesh square.obj --part Square=glass --texture Square=red.sbrdf.exr $lit -o none.exr
  [ "$status" -eq 2 ]
  [[ "$output" == *"glass, which has no place for a texture"* ]]
  [ ! -e none.exr ]
}

@test "words that are wrong are usage errors" {
  while read -r words told; do
    # shellcheck disable=SC2086
    run render-osmesa --mesh cube.obj --texture "Cube=four.sbrdf.exr$words" $lit -o none.exr
    [ "$status" -eq 2 ] && [[ "$output" == *"$told"* ]] && [ ! -e none.exr ] || { echo "$words: $status $output"; false; }
  done <<'LIST'
,project=pinwheel there is no projection "pinwheel"
,project=planar,axis=w axis is x, y, z
,project=planar,axis=0,0,0 axis is x, y, z
,project=box,axis=x a box has no axis
,project=planar,scale=0 scale is the width
,project=planar,center=1,2 center is a place
,project=planar,turn=much turn is a number
,project=planar,size=3 "size" is none of
*2,project=decal a decal is laid once
*0 the number after *
LIST
  # shellcheck disable=SC2086
  run render-osmesa --mesh square.obj --texture Square=four.sbrdf.exr,scale=2 $lit -o none.exr
  [ "$status" -eq 2 ]
  [[ "$output" == *"name a projection"* ]]
}
