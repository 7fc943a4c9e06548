# paint-pick --probe: what single pixels of a picture with buffers show.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  # A panel that faces +Z, seen from the front, and a matt paint of reflectances .8 .1 .1.
  cat >panel.obj <<'OBJ'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
o door
usemtl lacquer
f 1 2 3 4
OBJ
  awk 'BEGIN { p = atan2(0, -1)
    print "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\"><paint name=\"red\"><lobes space=\"lin_rec2020_scene\" basis=\"none\" method=\"l1\" max_de00=\"0\" mean_de00=\"0\">"
    printf "<diffuse r=\"%.9g\" g=\"%.9g\" b=\"%.9g\"/></lobes></paint></paints>\n", .8 / p, .1 / p, .1 / p }' >red.xml
  render-osmesa -q --mesh panel.obj -p red.xml --light 30,0,1,1,1@0 --light 0,60,0,0,0@0 --camera 0,0,8,0,0,0,30 --size 91x61 \
    --samples 1 --effects auto,-rays --aov normal,part -o view.exr
}

near() { awk -v x="$1" -v y="$2" -v d="$3" 'BEGIN { exit !(x - y <= d && y - x <= d) }' || { echo "$1 is not $2"; return 1; }; }

@test "the middle pixel has the part, the angles and the color that follow by hand" {
  paint-pick -q view.exr --probe 45,30 -o found.tsv --report r.json
  [ "$(head -1 found.tsv | cut -f1-5 | tr '\t' ' ')" = "x y part material aspecular_deg" ]
  [ "$(sed -n 2p found.tsv | cut -f1-4 | tr '\t' ' ')" = "45 30 door lacquer" ]
  # Seen straight from the front, the mirror direction is the normal, and the lights stand 30 and 60 degrees from it.
  near "$(jq '.results.probes[0].aspecular_deg[0]' r.json)" 30 1e-3
  near "$(jq '.results.probes[0].aspecular_deg[1]' r.json)" 60 1e-3
  near "$(jq '.results.probes[0].view_deg' r.json)" 0 1e-3
  # A lamp shows a white diffuser that faces it as 1: the panel shows .8 cos(30 deg), as halves of the file hold it.
  near "$(jq '.results.probes[0].rgb[0]' r.json)" 0.69282 1e-5
  near "$(jq '.results.probes[0].rgb[1]' r.json)" 0.086603 1e-5
}

@test "the exposure of the file does not count, and pixels beside the mesh have a color alone" {
  render-osmesa -q --mesh panel.obj -p red.xml --light 30,0@0 --camera 0,0,8,0,0,0,30 --size 91x61 --samples 1 --exposure -2 \
    --effects auto,-rays --aov normal,part -o dark.exr
  paint-pick -q view.exr --probe 45,30 -o found.tsv
  paint-pick -q dark.exr --probe 45,30 --probe 0,0 -o dark.tsv --report r.json
  [ "$(sed -n 2p found.tsv | cut -f9-11)" = "$(sed -n 2p dark.tsv | cut -f9-11)" ]
  [ "$(jq '.results.probes[1].part' r.json)" = null ]
  [ "$(sed -n 3p dark.tsv | cut -f1-5 | tr '\t' ' ')" = "0 0   " ]
}

@test "lines of standard input are answered one by one" {
  printf '45,30\n\n 44 , 30\n45,31' | paint-pick -q view.exr --probe - -o found.tsv
  [ "$(wc -l <found.tsv)" -eq 4 ]
  [ "$(sed -n 3p found.tsv | cut -f1,2 | tr '\t' ' ')" = "44 30" ]
  run bash -c "printf '45,30\nx\n' | paint-pick view.exr --probe - -o found.tsv"
  [ "$status" -eq 2 ]
  [[ "$output" =~ 'standard input:2 is "x": write X,Y' ]]
}

@test "what cannot be probed is told" {
  run paint-pick view.exr --probe 91,0
  [ "$status" -eq 2 ]
  [[ "$output" =~ "91,0 lies outside of view.exr, which has 91 x 61" ]]
  run paint-pick --probe 1,1
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--probe takes a picture with buffers: name one" ]]
  render-osmesa -q --mesh panel.obj -p red.xml --light 30,0 --size 9x6 --samples 1 -o bare.exr
  run paint-pick bare.exr --probe 1,1
  [ "$status" -eq 3 ]
  [[ "$output" =~ "--aov" ]]
  run paint-pick view.exr --probe 1,1 --palette 3
  [ "$status" -eq 2 ]
  [[ "$output" =~ "exclude each other" ]]
}
