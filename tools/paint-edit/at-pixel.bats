#!/usr/bin/env bats
# paint-edit on a picture: the angle under a pixel.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  cat >one.paints.xml <<XML
<paints xmlns="urn:goniochrome:paint:1" version="1">
  <paint name="one" class="metallic"><gloss angle="60">50</gloss>
    <appearance travel="75"><face L="60" a="40" b="20"/><flop L="20" a="10" b="0"/></appearance></paint>
</paints>
XML
  # Columns of ten pixels that see 15, 45 and 75 deg, a last one beside the mesh, and a highlight of 5 deg.
  oiiotool --create 50x10 7 --chnames R,G,B,A,aspecular,lambert,mask \
    --fill:color=0,0,0,1,15,1,1 10x10+0+0 --fill:color=0,0,0,1,45,1,1 10x10+10+0 --fill:color=0,0,0,1,75,1,1 10x10+20+0 \
    --fill:color=0,0,0,0,180,0,0 10x10+30+0 --fill:color=0,0,0,1,5,1,1 10x10+40+0 -d float -o scene.exr
}

# end WHAT: L a b of face or flop.
end() { grep -oE "<$1 [^>]*" out.paints.xml | grep -oE '"[^"]*"' | tr -d '"' | tr '\n' ' '; }
tweak() { paint-edit -q one.paints.xml --image scene.exr -o out.paints.xml --report r.json "$@"; }

@test "a move under a pixel falls on face and flop by its angle" {
  tweak --at-pixel 5,5 --lighter 6
  [ "$(end face)" = "66 40 20 " ]
  [ "$(end flop)" = "20 10 0 " ]
  jq -e '.results.pixels[0].aspecular_deg == 15' r.json
  [ "$(jq -r '.results.pixels[0].option' r.json)" = --at-pixel ]
  # The curve at 45 deg is 1/4 face and 3/4 flop. The least changes that make 6 of it are 6/(1/16 + 9/16) times these.
  tweak --at-pixel 15,5 --lighter 6
  [ "$(end face)" = "62.4 40 20 " ]
  [ "$(end flop)" = "27.2 10 0 " ]
  tweak --at-pixel 15,5 --lighter 6 --share source # (75-45)/(75-15): half each
  [ "$(end face)" = "63 40 20 " ]
  [ "$(end flop)" = "23 10 0 " ]
  tweak --at-pixel 25,5 --lighter 6
  [ "$(end face)" = "60 40 20 " ]
  [ "$(end flop)" = "26 10 0 " ]
}

@test "there chroma is a factor and hue a turn" {
  tweak --at-pixel 5,5 --chroma 1.5
  [ "$(end face)" = "60 60 30 " ]
  tweak --at-pixel 25,5 --hue 90
  awk '{ exit !($2 < 1e-9 && $2 > -1e-9 && $3 > 9.99 && $3 < 10.01) }' <<<"$(end flop)"
  paint-edit -q one.paints.xml --at 45 --lightness-shift 3 --chroma-factor 1.1 --hue-shift 5 -o at.paints.xml
  tweak --at-pixel 15,5 --lighter 3 --chroma 1.1 --hue 5
  [ "$(grep -E '<(face|flop) ' at.paints.xml)" = "$(grep -E '<(face|flop) ' out.paints.xml)" ]
}

@test "the travel ends at a pixel, and so does the highlight" {
  tweak --travel-to 15,0
  grep -q 'travel="45"' out.paints.xml
  gloss() { grep -oE '<gloss angle="60">[0-9.]+' out.paints.xml | grep -oE '[0-9.]+$'; }
  tweak --gloss-to 45,5
  sharp=$(gloss)
  tweak --gloss-to 5,5
  wide=$(gloss)
  awk -v s="$sharp" -v w="$wide" 'BEGIN { exit !(s > w + 10 && w > 0 && s < 89.2) }' # a smooth coat reads 89.1
  tweak --gloss-to 45,5 --gloss-angle 20
  grep -q '<gloss angle="20">' out.paints.xml
}

@test "the angle is that of the renderer's own buffers" {
  render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --light 30,50 --size 96x60 --effects auto,-rays --aov aspecular,mask -o car.exr
  paint-edit one.paints.xml --image car.exr --at-pixel 40,30 --lighter 1 -o out.paints.xml --report r.json 2>said
  grep -qE '^--at-pixel 40,30 is [0-9.]+ deg from specular$' said
  oiiotool car.exr --ch aspecular --cut 1x1+40+30 -o pixel.exr
  there=$(oiiotool --dumpdata pixel.exr | tail -1 | grep -oE '[0-9.]+$')
  awk -v x="$(jq '.results.pixels[0].aspecular_deg' r.json)" -v y="$there" 'BEGIN { exit !(x - y < 1e-4 && y - x < 1e-4) }'
}

@test "in traced light the angle is that of the light there, for the mesh may hide the lamp" {
  cat >stage.obj <<'OBJ'
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -0.3 0 0
v 0.3 0 0
v 0.3 0.8 0
v -0.3 0.8 0
o floor
f 4 3 2 1
o post
f 5 6 7 8
OBJ
  # The camera looks from where the mirror image of the lamp is seen on the floor behind the post.
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  oiiotool --create 32x16 3 --fill:color=0.3,0.3,0.3 32x16 -o even.exr
  prefilter-envmap -q even.exr --basis "$TESTDATA/b5.basis.xml" --tolerance 1e-2 -o even.env.exr
  render-osmesa -q --mesh stage.obj --size 32x24 --samples 1 --camera 0,4,-2.5,0,0,-0.4,30 -p fitted.xml#silver_fine \
    --light 0,50,3,3,3@0 --env even.env.exr --engine path --floor none --tolerance 2 --aov aspecular,mask,transport -o view.exr
  oiiotool view.exr --subimage 0 --ch R,G,B,A,aspecular,mask --eraseattrib "goniochrome:transport" -o plain.exr
  # angle FILE X,Y: what the move is made at
  angle() {
    paint-edit -q one.paints.xml --image "$1" --at-pixel "$2" --lighter 6 -o out.paints.xml --report r.json
    jq '.results.pixels[0].aspecular_deg' r.json
  }
  # In the lamp's light both agree, though the even light widens the angle; in its shadow only the even light is left,
  # of which the post hides a part; it shows the paint between face (15) and flop.
  lit=$(angle view.exr 4,12) lamp_lit=$(angle plain.exr 4,12)
  hidden=$(angle view.exr 16,12) lamp_hidden=$(angle plain.exr 16,12)
  echo "lit $lit $lamp_lit, hidden $hidden $lamp_hidden"
  [ "$(jq '.results.pixels[0].traced' r.json)" = false ]
  awk -v a="$lit" -v b="$lamp_lit" 'BEGIN { exit !(a - b < 12 && b - a < 12) }'
  awk -v a="$hidden" 'BEGIN { exit !(a > 25 && a < 75) }'
  awk -v b="$lamp_hidden" 'BEGIN { exit !(b < 15) }'
  run paint-edit one.paints.xml --image view.exr --at-pixel 16,12 --lighter 6 -o out.paints.xml
  [[ $output == *"--at-pixel 16,12 gets light as from one lamp "*" deg from specular"* ]]
}

usage_error() { # TEXT ARGUMENTS...
  local text=$1
  shift
  run paint-edit one.paints.xml -o none.xml "$@"
  [ "$status" -eq 2 ] || { echo "$* gave $status: $output"; return 1; }
  [[ $output == *"$text"* ]] || { echo "$* said: $output"; return 1; }
  [ ! -e none.xml ]
}

@test "usage errors name the option, the pixel and the remedy" {
  usage_error "--at-pixel, --travel-to and --gloss-to need --image" --at-pixel 1,1 --lighter 2
  usage_error "--image lacks a place in it" --image scene.exr --lightness-shift 2
  usage_error "--at-pixel takes a pixel: write --at-pixel X,Y" --image scene.exr --at-pixel 1 --lighter 2
  usage_error "--at-pixel takes a pixel" --image scene.exr --at-pixel 1.5,2 --lighter 2
  usage_error '--at-pixel is "-1"' --image scene.exr --at-pixel=-1,2 --lighter 2
  usage_error "--travel-to takes a pixel" --image scene.exr --travel-to 1
  usage_error "--gloss-to takes a pixel" --image scene.exr --gloss-to 1,2,3
  usage_error "--at-pixel is 50,2: scene.exr has 50 x 10 pixels" --image scene.exr --at-pixel 50,2 --lighter 2
  usage_error "--at-pixel is 35,2: no mesh is seen there" --image scene.exr --at-pixel 35,2 --lighter 2
  usage_error "a travel lies above 15: go farther from the light" --image scene.exr --travel-to 45,2
  usage_error "--lighter is for --at-pixel: use --lightness-shift" --lighter 2
  usage_error '--lighter is "much"' --image scene.exr --at-pixel 5,5 --lighter much
  usage_error "--at-pixel lacks" --image scene.exr --at-pixel 5,5
  usage_error "--at and --at-pixel name two places" --image scene.exr --at-pixel 5,5 --at 30 --lighter 2
  usage_error "is told one move twice" --image scene.exr --at-pixel 5,5 --lighter 2 --lightness-shift 2
  usage_error "--travel and --travel-to exclude each other" --image scene.exr --travel-to 15,5 --travel 30
  usage_error "--gloss and --gloss-to exclude each other" --image scene.exr --gloss-to 45,5 --gloss 30
}

@test "an image without the buffer is told how to make one" {
  oiiotool scene.exr --ch R,G,B,A,mask -o lacking.exr
  run paint-edit one.paints.xml --image lacking.exr --at-pixel 5,5 --lighter 2 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *'lacking.exr: has no channel "aspecular": make the buffers by render-osmesa'* ]]
  run paint-edit one.paints.xml --image missing.exr --at-pixel 5,5 --lighter 2 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *missing.exr* ]]
}
