# The light of a view by lobes, and other paints in it.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 32x16 -o studio.exr
  prefilter-envmap -q studio.exr --basis "$TESTDATA/b5.basis.xml" --tolerance 1e-2 -o studio.env.exr
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  fit-paint -q --basis "$TESTDATA/b7.basis.xml" "$TESTDATA/paints.paints.xml" -o other-basis.xml
  # Two walls that meet: each hides light from the other and sends some back.
  cat >walls.obj <<'OBJ'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v 1 -1 2
v -1 -1 2
o back
f 1 2 3 4
o floor
f 6 5 2 1
OBJ
  render-osmesa -q --mesh walls.obj --size 32x24 --samples 1 --camera 0.6,0.8,4,0,-0.3,0,30 -p fitted.xml#silver_fine \
    --env studio.env.exr --aov transport --tolerance 3 -o view.exr --report view.json
}

setup() { cd "$BATS_FILE_TMPDIR" || exit 1; }

# figure KEY FILE
figure() { grep -m1 "\"$1\"" "$2" | sed -E 's/.*: ([-0-9.e+a-z]+),?$/\1/'; }

@test "a transport is told with its noise and size, and its parts are images of their own" {
  awk -v n="$(figure noise_de00_p95 view.json)" 'BEGIN { exit !(n > 0 && n <= 3) }'
  awk -v b="$(figure bytes_per_point view.json)" 'BEGIN { exit !(b > 100 && b < 600) }'
  exrheader view.exr >header.txt
  grep -q 'direct-diffuse' header.txt
  grep -q 'bounced-mirror' header.txt
}

@test "the paint that was worn is shown without an error of scaling, another one with the error told" {
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o same.exr --report same.json
  [ "$(figure trace_again same.json)" = false ]
  awk -v e="$(figure bounced_de00_p95 same.json)" 'BEGIN { exit !(e == 0) }'
  grep -q '"engine": "transport"' same.json
  run render-osmesa --gbuffer view.exr -p fitted.xml#signal_white --tolerance 1e-6 -o other.exr --report other.json
  [ "$status" -eq 1 ]
  [[ "$output" =~ "trace again with --aov transport in these paints" ]]
  awk -v e="$(figure bounced_de00_p95 other.json)" 'BEGIN { exit !(e > 0 && e < 5) }'
  run render-osmesa --gbuffer view.exr -p fitted.xml#signal_white --tolerance 20 -o other.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "scaled to these: off by" ]]
}

@test "the picture has the shadows that the engine path draws" {
  render-osmesa -q --mesh walls.obj --size 32x24 --samples 1 --camera 0.6,0.8,4,0,-0.3,0,30 -p fitted.xml#silver_fine \
    --env studio.env.exr --engine path --floor none --tolerance 2 -o path.exr
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o same.exr
  render-osmesa -q --mesh walls.obj --size 32x24 --samples 1 --camera 0.6,0.8,4,0,-0.3,0,30 -p fitted.xml#silver_fine \
    --env studio.env.exr --engine cpu --effects auto,-rays -o open.exr
  for picture in same open; do
    oiiotool path.exr --ch R,G,B $picture.exr --ch R,G,B --absdiff --printstats | awk '/Stats Avg/ { print $4 }' >$picture.txt
  done
  # The mean of what the noise of both leaves, against the light that the maps alone have.
  awk -v a="$(cat same.txt)" -v b="$(cat open.txt)" 'BEGIN { exit !(a < 0.35 * b) }'
}

@test "without a transport, --gbuffer is as it was" {
  render-osmesa -q --mesh walls.obj --size 32x24 --samples 1 --camera 0.6,0.8,4,0,-0.3,0,30 -p fitted.xml#silver_fine \
    --env studio.env.exr --engine cpu --effects auto,-rays --aov normal,part -o plain.exr
  run render-osmesa --gbuffer plain.exr -p fitted.xml#signal_white -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "there is no light: give --env, --light or both" ]]
  render-osmesa -q --gbuffer plain.exr -p fitted.xml#silver_fine --env studio.env.exr --engine cpu --aov normal,part -o again.exr
  [ "$(oiiotool plain.exr --ch R,G,B again.exr --ch R,G,B --diff | tail -1)" = PASS ]
}

@test "a paint of another basis, a cut file and other light are told" {
  run render-osmesa --gbuffer view.exr -p other-basis.xml#silver_fine -o out.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "a paint has a lobe of exponent" ]]
  [[ "$output" =~ "fit the paint to that basis, or trace with this one" ]]
  head -c 20000 view.exr >cut.exr
  run render-osmesa --gbuffer cut.exr -p fitted.xml#silver_fine -o out.exr
  [ "$status" -eq 3 ]
  [ "$(echo "$output" | grep -c cut.exr)" -eq 1 ]
  run render-osmesa --gbuffer view.exr --light 30,50 -p fitted.xml#silver_fine -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "the picture has no shadows" ]]
  run render-osmesa --gbuffer view.exr -p fitted.xml#silver_fine --check 5 -o out.exr
  [ "$status" -eq 2 ]
  run render-osmesa --gbuffer view.exr --env studio.env.exr -p fitted.xml#silver_fine --aov transport -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "traces one view of a mesh" ]]
}

@test "a floor that shows the environment is in the transport, and keeps what it shows when a sketch is fitted" {
  view=(--mesh walls.obj --size 32x24 --samples 1 --camera "0.6,0.8,4,0,-0.3,0,30" --env studio.env.exr --engine path
    --floor shadow,-1.2 --tolerance 3)
  render-osmesa -q "${view[@]}" -p fitted.xml#silver_fine --aov aspecular,lambert,mask,part,transport -o on-floor.exr
  render-osmesa -q "${view[@]}" -p fitted.xml#silver_fine -o anew.exr
  render-osmesa -q --gbuffer on-floor.exr -p fitted.xml#silver_fine -o shaded.exr
  # Light of both pictures, floor and all; they differ by noise.
  mean() { oiiotool --stats "$1" | awk '/Stats Avg/ { print $4 }'; }
  awk -v a="$(mean anew.exr)" -v b="$(mean shaded.exr)" 'BEGIN { exit !(a > 0 && b / a > 0.97 && b / a < 1.03) }'
  sketch-fit -q --pixels all -i anew.exr -b on-floor.exr -o sketch.xml --report sketch.json
  # Many of the 768 pixels show the floor, and none of them the paint.
  walls=$(render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o walls.exr && oiiotool --stats walls.exr | awk '/Stats Avg/ { print $6 }')
  awk -v p="$(figure pixels_used sketch.json)" -v share="$walls" 'BEGIN { exit !(p > 50 && p <= 768 * share) }'
}

@test "a picture shaded from the transport in its own paint is no edit of it, and an edit of it is found" {
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o own.png
  sketch-fit -q -i own.png -b view.exr -o sketch.xml --report sketch.json
  [ "$(jq .results.pixels_rule sketch.json)" = '"all"' ]
  [ "$(jq .results.pixels_changed sketch.json)" -eq 0 ]
  [ "$(jq .results.pixels_compared_with sketch.json)" = '"transport"' ]
  # A third of it, recolored.
  oiiotool own.png --cut 11x24+0+0 --mulc 1,0.6,0.5 own.png --paste +0+0 -d uint8 -o brushed.png
  sketch-fit -q -i brushed.png -b view.exr -o sketch.xml --report sketch.json
  [ "$(jq .results.pixels_rule sketch.json)" = '"changed"' ]
  [ "$(jq '.results | .pixels_changed == .pixels_used and .pixels_changed > 40 and .pixels_changed <= 264' sketch.json)" = true ]
}

# A search for its paint takes the light of as many.
@test "a picture tells of how many samples the points of its transport are the mean" {
  render-osmesa -q --mesh walls.obj --size 10x6 --samples 4 -p fitted.xml#silver_fine --env studio.env.exr --aov transport \
    --tolerance 20 -o mean.exr
  render-osmesa -q --gbuffer mean.exr -p fitted.xml#silver_fine -o shown.exr
  [[ "$(oiiotool --info -v shown.exr)" =~ "goniochrome:samples: 4" ]]
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o shown.exr
  [[ "$(oiiotool --info -v shown.exr)" =~ "goniochrome:samples: 1" ]]
}

@test "several points are a pixel: their mean, in single pictures and in streams" {
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine -o points.exr
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine --samples 4 -o pixels.exr --report pixels.json
  oiiotool points.exr --resize:filter=box 16x12 -o means.exr
  oiiotool points.exr --resample:interp=0 16x12 -o single.exr
  apart() { oiiotool "$1" "$2" --absdiff --printstats | awk '/Stats Max/ { m = 0; for (i = 3; i <= 5; ++i) if ($i > m) m = $i; print m }'; }
  # Halves of values below 4; the control takes one point of four.
  awk -v a="$(apart pixels.exr means.exr)" 'BEGIN { exit !(a < 0.004) }'
  awk -v a="$(apart pixels.exr single.exr)" 'BEGIN { exit !(a > 0.02) }'
  render-osmesa -q --gbuffer view.exr -p fitted.xml#silver_fine --samples 16 -o four.exr
  [[ "$(oiiotool --info four.exr)" =~ "8 x    6" ]]
  render-osmesa -q --gbuffer view.exr -p 'fitted.xml#silver_fine' --samples 4 -o '{name}.exr'
  [ "$(oiiotool silver_fine.exr pixels.exr --diff | tail -1)" = PASS ]
  run render-osmesa --gbuffer view.exr -p fitted.xml#silver_fine --samples 4 --aov normal -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--aov holds pixel centers" ]]
  render-osmesa -q --mesh walls.obj --size 10x6 --samples 1 -p fitted.xml#silver_fine --env studio.env.exr --aov transport \
    --tolerance 30 -o odd.exr
  run render-osmesa --gbuffer odd.exr -p fitted.xml#silver_fine --samples 16 -o out.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "10 x 6 points, which are no whole squares of 4 x 4" ]]
}
