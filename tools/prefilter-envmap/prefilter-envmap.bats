# prefilter-envmap from the outside: options, streams, exit statuses.

bats_require_minimum_version 1.5.0

# Exact sums over a sky of half the size take a quarter of the time.
setup_file() { oiiotool "$TESTDATA/outdoor.exr" --resize:filter=box 512x256 -o "$BATS_FILE_TMPDIR/outdoor.exr"; }

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  basis=$TESTDATA/b5.basis.xml
  sky=$BATS_FILE_TMPDIR/outdoor.exr
}

# values KEY: every value of that key in the report, one a line.
values() { grep "\"$1\"" r.json | sed -E 's/.*: "?([^",]+)"?,?$/\1/'; }

# within LIMIT: every number of standard input is at most that, and there are some.
within() { awk -v limit="$1" '$1 > limit { bad = 1 } { n++ } END { exit bad || !n }'; }

@test "a sky is filtered by a basis, and the verified error is within the tolerance" {
  run --separate-stderr prefilter-envmap --basis "$basis" --size 16 --verify 10 "$sky" -o sky.env.exr --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ ^"prefilter-envmap: "[0-9]+" lobes in "[0-9.]+" s; largest error "[0-9.e-]+" of 12 texels a lobe, tolerance 0.001"$ ]]
  values max_rel_error | within 1e-3
  values energy_ratio | head -1 | awk '{ if ($1 < .999 || $1 > 1.001) exit 1 }'
  for time in read_s filter_s verify_s open_maps_s write_s; do [ "$(values "$time" | wc -l)" -eq 1 ]; done
}

@test "the file has its parts and attributes" {
  command -v exrheader >/dev/null || skip "no exrheader"
  prefilter-envmap -q -e 6,70 --size 8 --verify 4 "$sky" -o sky.env.exr
  exrheader sky.env.exr >header
  for name in diffuse lobe-000 lobe-001 mirror; do grep -q "\"$name\"" header; done
  # Those that follow from them.
  for name in coat-diffuse open-coat-diffuse open-diffuse open-lobe-000 open-lobe-001; do grep -q "\"$name\"" header; done
  [ "$(grep -c 'goniochrome:version (type int): 1' header)" -eq 5 ]
  [ "$(grep -c 'goniochrome:texels.*"center"' header)" -eq 9 ]
  [ "$(grep -c 'colorInteropID.*"lin_rec2020_scene"' header)" -eq 9 ]
  # An environment without bright spots has one such part.
  prefilter-envmap -q -e 6 --size 8 --spots 0 "$sky" -o even.env.exr
  [ "$(exrheader even.env.exr | grep -c 'goniochrome:version')" -eq 1 ]
  prefilter-envmap -q -e 6,70 --size 8 --no-open-maps "$sky" -o bare.env.exr
  [ "$(exrheader bare.env.exr | grep -c 'goniochrome:version')" -eq 0 ]
  [ "$(exrheader bare.env.exr | grep -c 'goniochrome:brightSpots')" -eq 1 ]
  grep -q 'goniochrome:exponent (type float): 70' header
  grep -q 'goniochrome:maxError' header
  grep -q 'goniochrome:command.*prefilter-envmap [0-9.]*: prefilter-envmap -q -e 6,70' header
  grep -q "goniochrome:source.*outdoor.exr" header
}

@test "standard input goes to standard output" {
  prefilter-envmap -q -e 20 --size 8 <"$sky" >a.env.exr
  prefilter-envmap -q -e 20 --size 8 - -o - <"$sky" >b.env.exr
  [ -s a.env.exr ]
  [ "$(wc -c <a.env.exr)" -gt 1000 ]
}

@test "the bits do not depend on the threads" {
  for threads in 1 2 7; do
    prefilter-envmap -q -e 1.3,20,900 --size 8 --threads "$threads" "$sky" -o out.env.exr
    # The command line in the file differs by one digit.
    LC_ALL=C sed 's/--threads [0-9]/--threads N/g' out.env.exr | cksum >>sums
  done
  [ "$(sort -u sums | wc -l)" -eq 1 ]
}

@test "an exponent named twice and exponent 1 are filtered once" {
  prefilter-envmap -q -e 6,1,6 --size 8 --no-mirror --report r.json "$sky" -o out.env.exr
  [ "$(values exponent | tr '\n' ' ')" = "1.0 6.0 " ]
}

@test "the plan comes before the work" {
  run --separate-stderr prefilter-envmap -e 0.3,6,1e5 --size 4 --explain "$TESTDATA/outdoor.exr" -o out.env.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "1024 x 512 texels, each a constant patch" ]]
  [[ "$stderr" =~ 0.3\ +4\ +harmonics ]]
  [[ "$stderr" =~ 6\ +4\ +harmonics ]]
  [[ "$stderr" =~ 1e\+05\ +4\ +local\ sums ]]
}

@test "usage errors name the option and the remedy" {
  run prefilter-envmap -b "$basis" -e 6 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--basis, --exponents and --for exclude each other: give one of them" ]]
  run prefilter-envmap -e 6,-1 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 --size big "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ '--size is "big": give auto' ]]
  run prefilter-envmap -e 6 --tolerance 1 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--tolerance is 1: give 1e-06 or more, and less than 1" ]]
  run prefilter-envmap -e 6 --tolerance 1e-9 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 "$sky" "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "2 files were given: a cube takes six" ]]
  [ ! -e x.env.exr ]
}

@test "bad input is told by name" {
  run prefilter-envmap -e 6 absent.exr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "prefilter-envmap: absent.exr: cannot be read: No such file" ]]
  head -c 20000 "$sky" >cut.exr
  run prefilter-envmap -e 6 cut.exr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "cut.exr: " ]]
  run prefilter-envmap -b absent.xml "$sky" -o x.env.exr
  [ "$status" -eq 3 ]
  run prefilter-envmap -e 6 "$sky" -o absent/x.env.exr
  [ "$status" -eq 3 ]
  [ ! -e x.env.exr ]
}

@test "a missing module for PNG, JPEG and TIFF is told with its remedy" {
  printf 'P6\n2 1\n255\n123123' >tiny.ppm
  oiiotool tiny.ppm -o tiny.png
  GONIOCHROME_MODULE_PATH=/nowhere run prefilter-envmap -e 6 tiny.png -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "/nowhere/goniochrome-codecs.so: cannot be loaded" ]]
  [[ "$output" =~ "GONIOCHROME_MODULE_PATH" ]]
  run prefilter-envmap -q -e 6 --size 4 tiny.png -o x.env.exr
  [ "$status" -eq 0 ]
  [ -s x.env.exr ]
}

@test "a missing oiiotool is told with its remedy, and one that gives up with its reason" {
  printf 'P6\n2 1\n255\n123123' >tiny.ppm
  oiiotool tiny.ppm -o tiny.bmp
  tool=$(command -v prefilter-envmap)
  PATH=/nowhere run "$tool" -e 6 tiny.bmp -o x.env.exr
  echo "$output"
  [ "$status" -eq 3 ]
  [[ "$output" =~ "tiny.bmp: is a picture of the format BMP, which OpenImageIO reads" ]]
  [[ "$output" =~ "install openimageio-tools, or OpenImageIO by pip, or convert" ]]
  head -c 30 tiny.bmp >cut.bmp
  run prefilter-envmap -q -e 6 --size 4 cut.bmp -o x.env.exr
  echo "$output"
  [ "$status" -eq 3 ]
  [[ "$output" =~ "cut.bmp: cannot be read as an image: " ]]
  run prefilter-envmap -q -e 6 --size 4 tiny.bmp -o x.env.exr
  [ "$status" -eq 0 ]
  [ -s x.env.exr ]
  # Nothing stays in the folder of temporary files.
  mkdir temporary
  TMPDIR=$PWD/temporary prefilter-envmap -q -e 6 --size 4 tiny.bmp -o x.env.exr
  [ -z "$(ls temporary)" ]
}

@test "EXR, Radiance HDR and PNM need no module" {
  printf 'P6\n2 1\n255\n123123' >tiny.ppm
  GONIOCHROME_MODULE_PATH=/nowhere prefilter-envmap -q -e 6 --size 4 tiny.ppm -o p.env.exr
  printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n12341234' >tiny.hdr
  GONIOCHROME_MODULE_PATH=/nowhere run prefilter-envmap -q -e 6 --size 4 tiny.hdr -o x.env.exr
  [ "$status" -eq 0 ]
  [ -s x.env.exr ]
  head -c 50 tiny.hdr >cut.hdr
  run prefilter-envmap -q -e 6 --size 4 cut.hdr -o y.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "cut.hdr: is cut short" ]]
  [ ! -e y.env.exr ]
}

@test "a probe of 32 x 16 with a lamp keeps the tolerance" {
  {
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n'
    for i in $(seq 512); do
      if [ "$i" -eq 150 ]; then printf '\xff\xf0\xe0\x89'; else printf "\\x80\\x$(printf %x $((i * 37 % 128)))\\x60\\x80"; fi
    done
  } >coarse.hdr
  prefilter-envmap -q -e 6 --size 4 --tolerance 1e-4 --verify 2 coarse.hdr -o x.env.exr --report r.json
  values max_rel_error | within 1e-4
  values method | grep -qx 'harmonics+bright'
  prefilter-envmap -q -e 70 --no-mirror --size 4 --tolerance 1e-6 --verify 2 coarse.hdr -o x.env.exr --report r.json
  values max_rel_error | within 1e-6
  values method | grep -qx 'harmonics+horizon'
  prefilter-envmap -q -e 0,0.3 --no-mirror --size 4 --tolerance 1e-5 --verify 2 coarse.hdr -o x.env.exr --report r.json
  values max_rel_error | within 1e-5
  values method | grep -qx 'harmonics+horizon'
  prefilter-envmap -q -e 1e5 --no-mirror --size 4 --tolerance 1e-5 --verify 2 coarse.hdr -o x.env.exr --report r.json
  values max_rel_error | within 1e-5
  values method | grep -qx 'local sums'
}

@test "a killed run leaves the old file" {
  echo old >out.env.exr
  timeout -s KILL 0.3 prefilter-envmap -q -e 0.3 --size 512 "$TESTDATA/outdoor.exr" -o out.env.exr || true
  [ "$(cat out.env.exr)" = old ]
  [ "$(ls -A | wc -l)" -eq 1 ]
}

# lobes_paint EXPONENT:WEIGHT... : a paint of those lobes on a black ground.
lobes_paint() {
  printf '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="P" class="metallic">'
  printf '<lobes space="lin_rec2020_scene" basis="b" method="l1" max_de00="0" mean_de00="0"><diffuse r="0.1" g="0.1" b="0.1"/>'
  for lobe in "$@"; do
    printf '<lobe exponent="%s" ddr="%s" ddg="0" ddb="0" gr="0" gg="0" gb="0"/>' "${lobe%:*}" "${lobe#*:}"
  done
  printf '</lobes></paint></paints>'
}

@test "--for filters only the lobes that paints need, and tells which were left out" {
  lobes_paint 6:0.2 70:0.00001 900:5 >p.paints.xml
  run --separate-stderr prefilter-envmap --for p.paints.xml --size 8 --explain --report r.json "$sky" -o out.env.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "left out: 70: at most "[0-9.e-]+" of what any of 1 paints reflects, below the tolerance 0.001" ]]
  jq -e '[.results.lobes[].exponent] == [1,6,900]' r.json
  jq -e '[.results.left_out[].exponent] == [70]' r.json
  lobes_paint 6:0.2 mirror:0.5 >m.paints.xml
  prefilter-envmap -q --for m.paints.xml --size 8 --report r.json "$sky" -o out.env.exr
  jq -e '[.results.lobes[].exponent] == [1,6,"mirror"]' r.json
  run prefilter-envmap --for absent.xml "$sky" -o x.env.exr
  [ "$status" -eq 3 ]
  run prefilter-envmap --for p.paints.xml -e 6 "$sky" -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap --for "$TESTDATA/paints.paints.xml" "$sky" -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "has no lobes: fit it with fit-paint" ]]
  run prefilter-envmap --for
  [ "$status" -eq 2 ]
}

# Pixels are compressed and have a sum of their own. What stands beside them had none, such as the method that is told.
@test "a kept lobe of which a byte changed is made anew" {
  prefilter-envmap -q -e 6 --size 4 --no-mirror --cache kept "$sky" -o a.env.exr
  for file in kept/*.exr; do
    for changed in harmonics goniochrome:tolerance; do
      cp "$file" whole
      python3 - "$file" "$changed" <<'PY'
import sys
data = bytearray(open(sys.argv[1], "rb").read())
data[data.index(sys.argv[2].encode()) + (0 if sys.argv[2] == "harmonics" else 32)] ^= 1
open(sys.argv[1], "wb").write(data)
PY
      prefilter-envmap -q -e 6 --size 4 --no-mirror --cache kept --report r.json "$sky" -o b.env.exr
      [ "$(jq -c '[.results.lobes[].cached] | sort' r.json)" = "[false,true]" ]
      cp whole "$file"
    done
  done
}

@test "a cache gives lobes back by content" {
  prefilter-envmap -q -e 6,70 --size 8 --cache kept "$sky" -o a.env.exr
  [ "$(ls kept | wc -l)" -eq 4 ]
  cp "$sky" renamed.exr
  prefilter-envmap -q -e 6,900 --size 8 --cache kept --verify 5 --report r.json renamed.exr -o b.env.exr
  [ "$(jq -c '[.results.lobes[].cached]' r.json)" = "[true,true,false,true]" ]
  values max_rel_error | within 1e-3
  # Another exposure, turn, size, layout or tolerance is another lobe; a spoilt file is as none.
  for change in "--size 8 --exposure 1" "--size 8 --rotate 10" "--size 16" "--size 8 --layout latlong" \
    "--size 8 --tolerance 1e-4" "--size 8 --horizon 0"; do
    prefilter-envmap -q -e 6 --no-mirror --cache kept $change --report r.json "$sky" -o c.env.exr
    [ "$(jq -c '[.results.lobes[].cached]' r.json)" = "[false,false]" ]
  done
  for file in kept/*; do echo spoilt >"$file"; done
  prefilter-envmap -q -e 6 --size 8 --no-mirror --cache kept --verify 5 --report r.json "$sky" -o c.env.exr
  [ "$(jq -c '[.results.lobes[].cached]' r.json)" = "[false,false]" ]
  echo file >taken
  run prefilter-envmap -e 6 --cache taken "$sky" -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "taken: is no folder" ]]
  run prefilter-envmap -e 6 "$sky" -o x.env.exr --cache
  [ "$status" -eq 2 ]
}

@test "other layouts follow their own conventions and hold their exponents" {
  command -v exrheader >/dev/null || skip "no exrheader"
  prefilter-envmap -q -e 70 --size 8 --layout latlong --verify 5 --report r.json "$sky" -o flat.exr
  values max_rel_error | within 1e-3
  exrheader flat.exr >header
  [ "$(grep -c 'envmap.*latitude-longitude' header)" -eq 3 ]
  [ "$(grep -c 'dataWindow.*(0 0) - (15 7)' header)" -eq 3 ]
  prefilter-envmap -q -e 70 --size 8 --layout openexr --verify 5 --report r.json "$sky" -o edges.exr
  values max_rel_error | within 1e-3
  exrheader edges.exr >header
  [ "$(grep -c 'envmap.*cube' header)" -eq 3 ]
  # Files that were written that way are read that way.
  prefilter-envmap -q -e 6 --size 4 --no-mirror --report r.json edges.exr -o again.env.exr
  [ "$(jq -r .results.source.layout r.json)" = "cube with texel centers on the edges" ]
  prefilter-envmap -q -e 64,16 --size 8 --layout mip --verify 5 --report r.json "$sky" -o mip.exr
  values max_rel_error | within 1e-3
  exrheader mip.exr >header
  grep -q 'goniochrome:exponents.*"64 16 4 1"' header
  grep -q 'mip-map' header
  run prefilter-envmap -e 64 --size 12 --layout mip "$sky" -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "give a power of two" ]]
  run prefilter-envmap -e 1,2,3 --size 2 --layout mip "$sky" -o x.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 --layout sphere "$sky" -o x.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 "$sky" -o x.exr --layout
  [ "$status" -eq 2 ]
  [ ! -e x.exr ]
}

# made_probe FILE: a lat-long image of 64 x 32 without symmetry, with a lamp.
made_probe() {
  /usr/bin/python3 - "$1" <<'PY'
import sys
import numpy
texels = numpy.zeros((32, 64, 4), "u1")
texels[..., :3] = numpy.random.default_rng(1).integers(40, 255, (8, 16, 3)).repeat(4, 0).repeat(4, 1)
texels[..., 3] = 129
texels[5:7, 20:22, 3] = 133
open(sys.argv[1], "wb").write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n" + texels.tobytes())
PY
}

# ball_photograph FILE GROUND LEFT: what a camera at +Z sees of a mirror ball of radius 60 about 150,70, before a ground
# of that brightness, from the column LEFT on; the light is one over each half of the sphere.
ball_photograph() {
  /usr/bin/python3 - "$@" <<'PY'
import sys
import numpy
y, x = numpy.mgrid[0:140, 0:240] + 0.5
u, v = (x - 150) / 60, (70 - y) / 60
on_ball = u**2 + v**2 <= 1
nz = numpy.sqrt(numpy.maximum(0, 1 - u**2 - v**2))
d = numpy.stack([2 * nz * u, 2 * nz * v, 2 * nz**2 - 1], -1)
texels = numpy.zeros((140, 240, 4), "u1")
texels[..., :3] = numpy.where(on_ball[..., None], 64 + 128 * (d > 0), int(float(sys.argv[2]) * 128))
texels[..., 3] = 129
left = int(sys.argv[3])
header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 140 +X %d\n" % (240 - left)
open(sys.argv[1], "wb").write(header.encode() + numpy.ascontiguousarray(texels[:, left:]).tobytes())
PY
}

@test "the photograph of a mirror ball is unrolled wherever the ball lies" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  ball_photograph dark.hdr 0 0
  ball_photograph lit.hdr 0.5 0
  prefilter-envmap -q -e 40 --size 4 --layout ktx2 --ball auto dark.hdr -o dark.ktx2 --report dark.json
  prefilter-envmap -q -e 40 --size 4 --layout ktx2 --ball 150,70,60 lit.hdr -o lit.ktx2 --report lit.json
  jq -e '.results.source | .layout == "mirror ball" and (.ball.x - 150 | fabs) < 0.5 and (.ball.y - 70 | fabs) < 0.5
    and (.ball.radius - 60 | fabs) < 1' dark.json
  jq -e '.results.source.ball == {"x": 150, "y": 70, "radius": 60}' lit.json
  # Red is bright toward +X, green toward +Y and blue toward +Z: 1.5 there and 0.5 on the other side.
  /usr/bin/python3 - "$BATS_TEST_DIRNAME/readers" <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import cube_texture
for path in "dark.ktx2", "lit.ktx2":
    faces = cube_texture.ktx2(path)[1][0][:, 1:3, 1:3, :3].mean((1, 2))
    print(faces)
    for axis in range(3):
        assert abs(faces[2 * axis, axis] - 1.5) < 0.03 and abs(faces[2 * axis + 1, axis] - 0.5) < 0.03
PY
  # Directions that the picture does not show are not made up.
  ball_photograph cut.hdr 0 100
  run prefilter-envmap -e 6 --ball auto cut.hdr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "cut.hdr: the ball reaches from -"[0-9.]+",".*", beyond the picture of 140 x 140" ]]
  run prefilter-envmap -e 6 --ball auto lit.hdr -o x.env.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "lit.hdr: the ball's outline cannot be told from its background" ]]
  for wrong in "" 1,2 1,2,x 1,2,3,4 1,2,0 1,2,-3 1,2,nan; do
    run prefilter-envmap -e 6 --ball "$wrong" lit.hdr -o x.env.exr
    [ "$status" -ge 2 ]
  done
  run prefilter-envmap -e 6 --ball auto $(yes lit.hdr | head -6) -o x.env.exr
  [ "$status" -eq 2 ]
  run prefilter-envmap -e 6 lit.hdr -o x.env.exr --ball
  [ "$status" -eq 2 ]
  [ ! -e x.env.exr ]
}

@test "a square picture with light in its corners is told to be no angular probe" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  ball_photograph lit.hdr 0.5 100
  ball_photograph dark.hdr 0 100
  run --separate-stderr prefilter-envmap -e 6 --size 4 lit.hdr -o x.env.exr --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" = *"lit.hdr: is square and has light in its corners"*"give prefilter-envmap --ball auto"* ]]
  jq -e '(.results.warnings | length) == 1 and .results.source.layout == "angular probe"' r.json
  run --separate-stderr prefilter-envmap -e 6 --size 4 dark.hdr -o x.env.exr
  [[ "$stderr" != *"corners"* ]]
}

@test "cube textures for engines are read back by numpy: each level is the image filtered by its exponent" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  made_probe made.hdr
  for layout in ktx2 dds; do
    prefilter-envmap -q -e 64,16 --size 16 --layout $layout --verify 5 --report $layout.json made.hdr -o made.$layout
    jq -e ".results.layout == \"$layout\" and .results.clipped_to_rec709 == 0" $layout.json
  done
  # A finer tolerance takes floats, and a light beyond half floats as well.
  prefilter-envmap -q -e 4 --size 4 --layout ktx2 --tolerance 1e-5 made.hdr -o fine.ktx2
  prefilter-envmap -q -e 4 --size 4 --layout dds --exposure 20 made.hdr -o bright.dds
  /usr/bin/python3 - "$BATS_TEST_DIRNAME/readers" <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import cube_texture
image = cube_texture.flat_hdr("made.hdr")
pairs, levels = cube_texture.ktx2("made.ktx2")
exponents = [float(word) for word in pairs["goniochrome:exponents"].split()]
print(pairs)
assert exponents == [64, 16, 4, 1, 0.25] and [level.shape[1] for level in levels] == [16, 8, 4, 2, 1]
assert pairs["goniochrome:source"] == "made.hdr" and "--layout ktx2" in pairs["goniochrome:command"]
assert all(float(word) < 1e-3 for word in pairs["goniochrome:maxErrors"].split())
# The reference has 16 points a texel of the image; its own error is the larger one.
for found in levels, cube_texture.dds("made.dds"):
    print(cube_texture.largest_difference(found, exponents, image))
    assert cube_texture.largest_difference(found, exponents, image) < 0.005
# A swapped pair of faces or exponents does not pass.
assert cube_texture.largest_difference([level[[1, 0, 2, 3, 4, 5]] for level in levels], exponents, image) > 0.05
assert cube_texture.largest_difference([level.swapaxes(1, 2) for level in levels], exponents, image) > 0.05
assert cube_texture.largest_difference(levels[:2], [60, 16], image) > 0.005
assert cube_texture.largest_difference(cube_texture.ktx2("fine.ktx2")[1], [4, 1, 0.25], image) < 0.005
assert cube_texture.largest_difference(cube_texture.dds("bright.dds"), [4, 1, 0.25], image * 2**20) < 0.005
PY
}

@test "three.js reads every level of a cube texture as it was written" {
  node=$BATS_TEST_DIRNAME/../../build/prefilter-envmap-checks-npm
  command -v npm >/dev/null || skip "npm is not there"
  [ -d "$node/node_modules/three" ] || { mkdir -p "$node" && (cd "$node" && timeout 120 npm install --silent three) >/dev/null 2>&1; } ||
    skip "npm cannot install the package three"
  prefilter-envmap -q -e 64 --size 8 --layout ktx2 "$sky" -o sky.ktx2
  cp "$BATS_TEST_DIRNAME/readers/three_levels.mjs" "$node/three_levels.mjs"
  node "$node/three_levels.mjs" sky.ktx2 >three.json
  /usr/bin/python3 - "$BATS_TEST_DIRNAME/readers" <<'PY'
import json
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import cube_texture
import numpy
texture = json.load(open("three.json"))
levels = cube_texture.ktx2("sky.ktx2")[1]
assert texture["halves"] and texture["linear"] and texture["exponents"] == "64 16 4 1"
assert len(texture["levels"]) == len(levels) == 4
for three, level in zip(texture["levels"], levels):
    assert three["width"] == three["height"] == level.shape[1]
    assert (numpy.array(three["bits"], "<u2").view("<f2") == level.ravel()).all()
PY
}

@test "colors beyond Rec.709 are clipped in a cube texture, and counted" {
  made_probe made.hdr
  prefilter-envmap -q -e 6 --size 4 --layout latlong --no-mirror made.hdr -o made.exr
  oiiotool made.exr --subimage 0 --mulc 0,1,0 --attrib colorInteropID lin_rec2020_scene -o green.exr
  run --separate-stderr prefilter-envmap -e 4 --size 4 --layout ktx2 green.exr -o green.ktx2 --report r.json
  [ "$status" -eq 0 ]
  jq -e '.results.clipped_to_rec709 == 126' r.json
  [[ "$stderr" = *"green.exr: 126 texels beyond Rec.709 clipped to it"* ]]
  run prefilter-envmap -e 64 --size 12 --layout ktx2 "$sky" -o x.ktx2
  [ "$status" -eq 2 ]
  run prefilter-envmap --basis absent.xml --layout dds "$sky" -o x.dds
  [ "$status" -eq 3 ]
  [ ! -e x.ktx2 ]
  [ ! -e x.dds ]
}

@test "--rotate, --exposure and --horizon change the environment; wrong ones are refused" {
  prefilter-envmap -q -e 6 --size 8 --verify 5 --rotate 30,20,-100 --exposure 2 --report r.json "$sky" -o a.env.exr
  values max_rel_error | within 1e-3
  prefilter-envmap -q -e 6 --size 8 --horizon 0 --verify 5 --report r.json "$sky" -o b.env.exr
  values max_rel_error | within 1e-3
  for bad in "--rotate 1,2,3,4" "--rotate 400" "--rotate x" "--exposure 99" "--exposure x" "--horizon 91" "--horizon x"; do
    run prefilter-envmap -e 6 $bad "$sky" -o x.env.exr
    [ "$status" -eq 2 ]
  done
  for missing in --rotate --exposure --horizon; do
    run prefilter-envmap -e 6 "$sky" -o x.env.exr $missing
    [ "$status" -eq 2 ]
  done
}

@test "bright spots are kept beside the maps, as many as are wanted, and turn with them" {
  prefilter-envmap -e 6 --report r.json "$sky" -o x.env.exr
  [ "$(jq '.results.spots | length' r.json)" -ge 1 ]
  jq -e '[.results.spots[].share] | add | . > 0.02 and . < 1' r.json
  exrheader x.env.exr | grep -q goniochrome:brightSpots
  prefilter-envmap -e 6 --rotate 90 --report turned.json "$sky" -o turned.env.exr
  # +Z goes toward +X.
  jq -e --slurpfile turned turned.json '.results.spots[0].direction as [$x, $y, $z]
    | $turned[0].results.spots[0].direction as [$u, $v, $w]
    | ($u - $z | fabs) < 1e-9 and ($v - $y | fabs) < 1e-9 and ($w + $x | fabs) < 1e-9' r.json
  prefilter-envmap -e 6 --spots 0 --report none.json "$sky" -o none.env.exr
  jq -e '.results | has("spots") | not' none.json
  run bash -c 'exrheader none.env.exr | grep brightSpots'
  [ "$status" -eq 1 ]
}

@test "inks are no light" {
  base64 -d >cmyk.jpg <<<'/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwAGBAUGBQQGBgUGBwcGCAoQCgoJCQoUDg8MEBcUGBgXFBYWGh0lHxobIxwWFiAsICMmJykqKRkfLTAtKDAlKCko/9sAQwEHBwcKCAoTCgoTKBoWGigoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgo/8AAFAgACAAIBAERAAIRAQMRAQQRAP/EABUAAQEAAAAAAAAAAAAAAAAAAAUI/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/EABUBAQEAAAAAAAAAAAAAAAAAAAYH/8QAFBEBAAAAAAAAAAAAAAAAAAAAAP/aAA4EAQACEQMRBAAAPwBAnQ1QL//Z'
  for images in cmyk.jpg "cmyk.jpg cmyk.jpg cmyk.jpg cmyk.jpg cmyk.jpg cmyk.jpg"; do
    run prefilter-envmap -e 4 $images -o none.exr
    [ "$status" -eq 3 ]
    [[ $output == *"cmyk.jpg is CMYK, and its inks were taken for RGB without regard to its profile: convert it to RGB"* ]]
    [ ! -e none.exr ]
  done
}

@test "the maps are shown side by side" {
  prefilter-envmap -q -e 4,70 --size 16 "$sky" --picture maps.png -o sky.env.exr
  # Diffuse, two lobes and mirror: three in a row, and one.
  run oiiotool --info maps.png
  [[ $output == *"992 x  388, 3 channel, uint8 png"* ]] || { echo "$output"; return 1; }
  # The sun is white in the mirror, and the diffuse map spreads its light over half of all directions.
  brightest() { oiiotool maps.png --cut "$1" --printstats 2>&1 | awk '/Stats Max/ { print $3 }'; }
  awk -v wide="$(brightest 320x160+8+30)" -v sharp="$(brightest 320x160+8+220)" 'BEGIN { exit !(sharp > 0.95 && wide < 0.9) }' ||
    { echo "$(brightest 320x160+8+30) $(brightest 320x160+8+220)"; return 1; }
  run prefilter-envmap -e 4 "$sky" --picture maps.jpg -o none.exr
  [ "$status" -eq 2 ]
  [[ $output == *'--picture is "maps.jpg": give a name that ends in .png'* ]]
  run prefilter-envmap -e 4 "$sky" --layout latlong --picture maps.png -o none.exr
  [ "$status" -eq 2 ]
  [[ $output == *"--picture shows cubes, and --layout latlong makes none"* ]]
  [ ! -e none.exr ]
}

@test "--sparkle adds the root mean square of each lobe, which is smaller than the lobe" {
  prefilter-envmap -q -e 6,70 "$sky" -o plain.env.exr
  prefilter-envmap -q -e 6,70 --sparkle "$sky" -o sparkle.env.exr --report r.json
  [ "$(exrheader sparkle.env.exr | grep -c 'rms-lobe-')" -eq 2 ]
  [ "$(stat -c %s sparkle.env.exr)" -le $((3 * $(stat -c %s plain.env.exr) / 2)) ]
  grep -q '"sparkle_s"' r.json
  run prefilter-envmap -e 6 --sparkle --layout latlong "$sky" -o no.exr
  [ "$status" -eq 2 ]
}
