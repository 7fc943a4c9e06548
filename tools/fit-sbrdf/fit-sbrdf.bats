# fit-sbrdf: photographs to a map of lobes.
bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  cp "$TESTDATA"/capture/* .
  chmod u+w ./*
}

fit() {
  fit-sbrdf -q -n 1 --width 2 --report r.json -o map.sbrdf.exr "$@" photos.csv
}

# refused WORDS ARGUMENTS...: exit 3, one line of error with WORDS in it, and no map.
refused() {
  local words=$1
  shift
  run --separate-stderr fit-sbrdf -q -n 1 --width 2 -o none.exr "$@"
  [ "$status" -eq 3 ] || { echo "exit $status: $stderr"; return 1; }
  [ "$(wc -l <<<"$stderr")" -eq 1 ] && [[ "$stderr" = *"$words"* ]] || { echo "$stderr"; return 1; }
  [ ! -e none.exr ]
}

@test "photographs held out are predicted, and the map is the surface that was photographed" {
  fit -k 4 --error-map error.png
  jq -e '.results | .texels == 384 and .width == 24 and .holdout_rel_error < 0.001 and .rel_error_median < 0.001' r.json
  jq -e '[.results.images[] | select(.held_out)] | length == 4' r.json
  jq -e '.results.methods | length == 2 and all(.texel_us > 0 and .rel_error < 0.01)' r.json
  # A texel in the middle of a red stripe: exponent 18, and diffuse and strength in the proportion of the truth.
  /usr/bin/python3 - <<'EOF'
import math, OpenImageIO as o
f = o.ImageBuf("map.sbrdf.exr")
names = f.spec().channelnames
for x, y in ((12, 0), (20, 8), (4, 8)):
    v = dict(zip(names, f.getpixel(x, y)))
    t = 0.5 + 0.5 * math.tanh(3 * math.sin(2 * math.pi * (x + y) / 16))
    n = 18 * (70 / 18) ** t
    assert abs(v["lobe0.n"] / n - 1) < 0.05, (v, n)
    assert abs(v["lobe0.x"] + 1) < 0.02 and abs(v["lobe0.y"] + 1) < 0.02 and v["lobe0.z"] == 1, v
    assert abs(v["lobe0.G"] / (0.05 * (n + 1) / (2 * math.pi)) - 1) < 0.05, v
    luminance = 0.2627 * v["diffuse.R"] + 0.6780 * v["diffuse.G"] + 0.0593 * v["diffuse.B"]
    red, blue = (0.42, 0.09, 0.07), (0.05, 0.10, 0.36)
    want = sum(w * (r + t * (b - r)) for w, r, b in zip((0.2126, 0.7152, 0.0722), red, blue)) / math.pi
    assert abs(luminance / want - 1) < 0.02, (luminance, want)
EOF
  # The error map has the size of the map, and is dark.
  [[ "$(oiiotool --info error.png)" = *"24 x   16"* ]]
}

@test "render-osmesa draws the map" {
  fit
  prefilter-envmap -q "$TESTDATA/studio.exr" --exponents 18,70 -s 8 -o sky.env.exr
  render-osmesa -q --engine cpu --mesh "$TESTDATA/box.obj" --env sky.env.exr --texture White=map.sbrdf.exr --size 32x24 --samples 1 -o seen.exr
}

# perspective: every photograph becomes one that another camera took of the plate, and c.csv has the corners.
perspective() {
  /usr/bin/python3 - <<'EOF'
import math, OpenImageIO as o
rows = open("photos.csv").read().splitlines()
first = next(i for i, row in enumerate(rows) if row.startswith("image,"))
rows[first] += "".join(f",corner{k}_{c}" for k in (1, 2, 3, 4) for c in "xy")
for i in range(first + 1, len(rows)):
    name = rows[i].split(",")[0]
    plate = o.ImageBuf(name)
    spec = plate.spec()
    width, height = 280 + 4 * (i % 5), 200 + 6 * (i % 3)
    turn, tilt, distance = 0.3 * math.sin(i), 0.5 * math.cos(1.7 * i), 6.0
    def seen(u, v):  # of the plate, 2.4 x 1.6, by a pinhole
        x, y = 2.4 * (u - 0.5), 1.6 * (v - 0.5)
        x, y = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
        far = distance + x * math.sin(tilt)
        return width / 2 + 480 * x * math.cos(tilt) / far, height / 2 + 480 * y / far
    def plate_at(px, py):
        a, b = (px - width / 2) / 480, (py - height / 2) / 480
        x = a * distance / (math.cos(tilt) - a * math.sin(tilt))
        y = b * (distance + x * math.sin(tilt))
        x, y = x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn)
        return x / 2.4 + 0.5, y / 1.6 + 0.5
    picture = o.ImageBuf(o.ImageSpec(width, height, 3, "uint16"))
    stored = plate.get_pixels(o.FLOAT)
    for py in range(height):
        for px in range(width):
            u, v = plate_at(px + 0.5, py + 0.5)
            if 0 <= u < 1 and 0 <= v < 1:
                picture.setpixel(px, py, [float(c) for c in stored[int(v * spec.height)][int(u * spec.width)]])
    picture.write(name)
    rows[i] += "".join(f",{c:.4f}" for corner in ((0, 0), (1, 0), (1, 1), (0, 1)) for c in seen(*corner))
open("c.csv", "w").write("\n".join(rows) + "\n")
EOF
}

@test "photographs in perspective are rectified from four corners" {
  perspective
  fit-sbrdf -q -n 1 --width 2 -k 4 -m dictionary --texels 24x16 --report r.json -o map.sbrdf.exr c.csv
  jq -e '.results | .width == 24 and .height == 16 and .holdout_rel_error < 0.01' r.json || { jq .results.holdout_rel_error r.json; false; }
  # The control: corners that are two texels to the right or to the left.
  awk -F, -v OFS=, '/^#/ || /^image/ { print; next } { for (k = 9; k < 17; k += 2) $k += NR % 2 ? 16 : -16; print }' c.csv >p.csv
  fit-sbrdf -q -n 1 --width 2 -k 4 -m dictionary --texels 24x16 --tolerance 1 --report r.json -o wrong.exr p.csv
  jq -e '.results.holdout_rel_error > 0.03' r.json || { jq .results.holdout_rel_error r.json; false; }
}

@test "corners that no plate has are one error" {
  perspective
  refused "has corners: give the texels of the map, as --texels 512x256" c.csv
  cp "$TESTDATA"/capture/stripes-*.png .
  refused "but the map is 12 x 8: mark the corners of the surface" --texels 12x8 photos.csv
  corners() { # corners AWK: of a photograph as large as the plate
    awk -F, -v OFS=, '/^#/ { print; next } /^image/ { print $0 ",corner1_x,corner1_y,corner2_x,corner2_y,corner3_x,corner3_y,corner4_x,corner4_y"; next }
      /^stripes-03/ { print $0, '"$1"'; next } { print $0, ",,,,,,," }' "$TESTDATA/capture/photos.csv" >p.csv
  }
  corners '"0,0,24,0,24,16,0,16"'
  run fit-sbrdf -n 1 --width 2 --texels 24x16 --explain -o map.sbrdf.exr p.csv
  [ "$status" -eq 0 ]
  [[ "$output" = *"1 photographs are rectified from their corners"* ]]
  corners '"2,2,8,5,14,8,0,16"'
  refused "stripes-03.png: the upper right corner is on the line through its neighbors" --texels 24x16 p.csv
  corners '"24,0,0,0,24,16,0,16"'
  refused "sides that cross or a dent: give them with the clock" --texels 24x16 p.csv
  corners '"-4,0,24,0,24,16,0,16"'
  refused "p.csv:6: " --texels 24x16 p.csv
  refused "stripes-03.png: the upper left corner is at -4,0, outside of the photograph of 24 x 16 pixels" --texels 24x16 p.csv
  run -2 fit-sbrdf --texels 24 -o none.exr p.csv
  [[ "$output" = *"--texels is \"24\""* ]]
}

@test "normals stay in the map, and pictures are drawn with them" {
  oiiotool --pattern constant:color=0.5,0.5,1 24x16 3 -d uint8 -o normals.png
  fit --normals normals.png
  [[ "$(oiiotool --info -v map.sbrdf.exr)" = *normal.x*normal.y*normal.z* ]]
  fit
  draw() {
    render-osmesa -q --engine cpu --mesh "$TESTDATA/box.obj" --light 30,50 --texture White=$1.sbrdf.exr --size 32x24 --samples 1 -o $1.exr
  }
  # One map with two normals. The one of the surface is the control.
  for normal in up=0,0,1 tilted=0.6,0,0.8; do
    oiiotool map.sbrdf.exr --pattern constant:color=${normal#*=} 24x16 3 --chnames normal.x,normal.y,normal.z --chappend -o ${normal%=*}.sbrdf.exr
  done
  paint-sbrdf -q tilted.sbrdf.exr --size 12x8 -o laid.sbrdf.exr
  for map in map up tilted laid; do draw $map; done
  idiff -q -fail 0.001 -warn 1 map.exr up.exr
  ! idiff -q -fail 0.02 -warn 1 map.exr tilted.exr || false
  idiff -q -fail 0.02 -failpercent 5 -warn 1 tilted.exr laid.exr
}

@test "the report tells all, and the summary tells error and time of both methods" {
  run --separate-stderr fit-sbrdf -n 1 --width 2 -k 2 --explain --report r.json -o map.sbrdf.exr photos.csv
  [ "$status" -eq 0 ]
  [[ "$stderr" = *"dictionary: median error "*" us a texel"*"nonlinear: median error "*"fit-sbrdf: 384 texels by "* ]]
  [[ "$stderr" = *"20 photographs, 2 of them held out; 1 lobes"*"0 photographs are rectified"* ]]
  jq -e '.tool == "fit-sbrdf" and (.results | has("uncertain") and has("fit_s") and has("read_s") and has("left_out_share"))' r.json
  for method in dictionary nonlinear; do
    fit -m $method
    jq -e ".results.method == \"$method\" and .results.holdout_rel_error == null" r.json
  done
}

@test "an error over the tolerance is a negative verdict" {
  run -1 fit --tolerance 1e-9
  [ -e map.sbrdf.exr ]
}

@test "8 bits, 16 bits and EXR give the same surface" {
  fit -k 4
  converted=()  # in one start of oiiotool, which is slow
  for i in stripes-*.png; do converted+=("$i" --colorconvert sRGB linear -d half -o "${i%.png}.exr"); done
  oiiotool "${converted[@]}"
  sed -i 's/\.png/.exr/' photos.csv
  fit -k 4
  jq -e '.results.holdout_rel_error < 0.002' r.json
  cp "$TESTDATA"/capture/* .
  converted=()
  for i in "$TESTDATA"/capture/*.png; do converted+=("$i" -d uint8 -o "${i##*/}"); done
  oiiotool "${converted[@]}"
  fit -k 4
  jq -e '.results.holdout_rel_error < 0.01' r.json
}

@test "a wrong exposure is named, left out, and mended if wanted" {
  sed -i 's/^\(stripes-05.png.*\),24$/\1,36/' photos.csv
  run --separate-stderr fit-sbrdf -n 1 --width 2 --report r.json -o map.sbrdf.exr photos.csv
  [ "$status" -eq 0 ]
  [[ "$stderr" = *"photos.csv:8: "*"stripes-05.png is 0.67 times as bright as the other photographs predict: its exposure should be 24; it was left out"* ]]
  jq -e '[.results.images[] | select(.wrong_exposure) | .image] == ["stripes-05.png"]' r.json
  fit --mend-exposures
  jq -e '.results.images[5] | .wrong_exposure and .rel_error < 0.01 and (.exposure_factor - 0.6667 | fabs) < 0.01' r.json
}

@test "the map is the same to the byte for any threads and tiles" {
  cp photos.csv p.csv
  fit-sbrdf -q -n 1 --width 2 -m dictionary --threads 1 p.csv >one.exr
  fit-sbrdf -q -n 1 --width 2 -m dictionary --threads 1 p.csv >again.exr
  cmp one.exr again.exr
  fit-sbrdf -q -n 1 --width 2 -m dictionary --threads 2 --tile 3 p.csv >two.exr
  oiiotool --fail 0 --warn 0 one.exr two.exr --diff
}

@test "photographs that the engine path makes of a map predict others of it, and so do spoiled ones" {
  for spoil in "" --spoil; do
    # shellcheck disable=SC2086
    "$BATS_TEST_DIRNAME/../../scripts/photograph-map" "$TESTDATA/wood.sbrdf.exr" -o rig$spoil --photos 28 --texels 12 --bin "$(dirname "$(command -v render-osmesa)")" $spoil
    fit-sbrdf -q -n 1 --width 2 -k 8 -m dictionary --report r.json -o rig.sbrdf.exr rig$spoil/photos.csv
    jq -e '.results.holdout_rel_error < 0.03' r.json || { jq -c .results.holdout_rel_error r.json; false; }
  done
  # The control: least squares take specks and shadows for good.
  fit-sbrdf -q -n 1 --width 2 -k 8 -m nonlinear --tolerance 1 --report r.json -o rig.sbrdf.exr rig--spoil/photos.csv
  jq -e '.results.holdout_rel_error > 0.06' r.json
}

@test "a table from standard input, and a mask" {
  oiiotool --pattern checker:width=8:height=8 24x16 1 -d uint8 -o mask.png
  fit-sbrdf -q -n 1 --width 2 --mask mask.png --report r.json -o map.sbrdf.exr <photos.csv
  jq -e '.results.texels == 192' r.json
}

@test "what is wrong with the photographs is one error with its remedy" {
  refused "photos.csv: 20 photographs to fit are too few for this many lobes: give at least 38" -k 30 photos.csv
  sed 's/stripes-03/absent/' photos.csv >p.csv
  refused "p.csv:6: absent.png: " p.csv
  oiiotool stripes-04.png --resize 20x16 -o small.png
  sed 's/stripes-04/small/' photos.csv >p.csv
  refused "p.csv:7: small.png is 20 x 16, but stripes-00.png is 24 x 16: register all photographs to one size" p.csv
  sed 's/^\(stripes-06.png,[^,]*,[^,]*\),/\1,-/' photos.csv >p.csv
  refused "p.csv:9: the light is below the surface" p.csv
  sed 's/^\(stripes-06.png\),/\1,x/' photos.csv >p.csv
  refused "p.csv:9: light_x is \"x" p.csv
  # Light and camera on one side: the mirror direction is never met.
  awk -F, -v OFS=, 'NR > 2 { $2 = 3; $3 = NR / 40; $4 = 4; $5 = 3; $6 = 0; $7 = 4 } { print }' photos.csv >p.csv
  refused "all photographs see the surface from one side of its highlight" p.csv
  oiiotool --pattern constant:color=1,1,1 24x16 3 -d uint8 -o even.png
  for i in stripes-*.png; do cp even.png "$i"; done
  refused "100 % of all pixels are saturated: photograph with a shorter exposure" photos.csv
  oiiotool --pattern constant:color=0,0,0 24x16 3 -d uint8 -o even.png
  for i in stripes-*.png; do cp even.png "$i"; done
  refused "100 % of all pixels are black: photograph with a longer exposure" photos.csv
  refused "absent.csv" absent.csv
}

@test "what is wrong with the command is told" {
  run -2 fit-sbrdf -n 3 -m nonlinear photos.csv -o map.exr
  [[ "$output" = *"--method nonlinear takes 1 or 2 lobes"* ]]
  run -2 fit-sbrdf -n 5 photos.csv -o map.exr
  run -2 fit-sbrdf --error-map e.jpg photos.csv -o map.exr
  [[ "$output" = *"ends in .exr or .png"* ]]
  oiiotool --pattern constant:color=1,1,1 5x5 1 -o mask.png
  refused "the mask is 5 x 5, but the photographs are 24 x 16" --mask mask.png photos.csv
}
