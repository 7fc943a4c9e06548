# Effects of rays: what the mesh does to light, drawn on the pictures of engines that do not know it.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 64x32 -o small.exr
  prefilter-envmap -q small.exr --basis "$TESTDATA/b5.basis.xml" -o small.env.exr
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  scene="--mesh $TESTDATA/box.obj -p fitted.xml#signal_white --env small.env.exr --size 48x36 --samples 1"
}

# of KEY EFFECT: that key of the effect in the plan of r.json.
of() { jq -r ".results.plan[] | select(.effect == \"$2\") | .$1" r.json; }

@test "shadow, self and bounce are drawn by default, and the first pass tells what they change" {
  render-osmesa -q $scene --effects auto,-rays -o before.exr --report r.json
  [ "$(of decision shadow)" = "forced off" ]
  [ "$(of de00_p95 shadow)" = null ]
  render-osmesa -q $scene --tolerance 2 -o out.exr --report r.json
  [ "$(of decision shadow)" = drawn ]
  [ "$(of needed bounce)" = true ]
  # All errors are within the tolerance, those of maps among them, unless the most samples were drawn.
  jq -e '.results.maps | .de00_p95 > 0 and .points > 100' r.json
  jq -e '.results | .rays.error_de00_p95 <= 2 or (.rays.reached | not)' r.json
  jq -e '.results.rays.samples | . > 0 and . <= 1024' r.json
  ! cmp -s before.exr out.exr || false
  # Beforehand the table says what is drawn and why, and then what the first pass found.
  run render-osmesa $scene --tolerance 2 --explain -o out.exr
  [[ "$output" =~ shadow\ +yes\ +-\ +drawn\ +"rays tell where" ]]
  [[ "$output" =~ "the first pass found".*shadow\ +[1-9][0-9.]*\ drawn ]]
}

@test "what the first pass shows to change little gets no second one, and the check sees no difference" {
  render-osmesa -q ${scene/signal_white/jet_black} --tolerance 2 --check 40 -o out.exr --report r.json || [ $? -eq 1 ]
  [ "$(of decision shadow)" = drawn ]
  [ "$(of decision bounce)" = "first pass alone" ]
  jq -e '.results.error | .bounce < 1e-6 and .noise < 2' r.json
  # Control: where it is seen, it goes on.
  render-osmesa -q $scene --tolerance 2 -o out.exr --report r.json
  [ "$(of decision bounce)" = drawn ]
}

@test "a convex shape is drawn as without rays, bit for bit, and takes none" {
  # An octahedron.
  printf 'v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n' >solid.obj
  for y in 3 4; do for x in 1 2; do for z in 5 6; do
    [ $(((x + y + z) % 2)) -eq 1 ] && echo "f $x $y $z" || echo "f $x $z $y"
  done; done; done >>solid.obj
  solid="--mesh solid.obj -p fitted.xml#silver_fine --env small.env.exr --light 30,50 --size 48x36 --samples 4"
  render-osmesa -q $solid --effects auto,-rays -o before.png
  # Sums correct prefiltered maps on a convex shape too, but only where rays are looked for: they are not what is compared.
  render-osmesa -q $solid --effects auto,-sums -o after.png --report r.json
  [ "$(of needed shadow)" = false ]
  [ "$(jq .results.rays r.json)" = null ]
  oiiotool before.png after.png --diff
}

@test "sums are drawn by name where no rays are traced, and a misspelled name is refused" {
  shape="--mesh $TESTDATA/speed-shape.obj -p fitted.xml#silver_fine --env small.env.exr --size 64x40 --samples 1"
  render-osmesa -q $shape --effects auto,-rays -o unnamed.png --report r.json
  [ "$(of needed sums)" = false ]
  [[ "$(of reason sums)" =~ "where sums are named" ]]
  render-osmesa -q $shape --effects auto,-rays,-sums -o off.png --report r.json
  [ "$(of decision sums)" = "forced off" ]
  oiiotool unnamed.png off.png --diff
  render-osmesa -q $shape --effects auto,-rays,+sums -o on.png --report r.json
  [ "$(of decision sums)" = "forced on" ]
  [[ "$(of reason sums)" =~ "sums over the environment" ]]
  run oiiotool off.png on.png --diff
  [ "$status" -ne 0 ]
  run render-osmesa -q $shape --effects auto,+sum -o wrong.png
  [ "$status" -eq 2 ]
  [[ "$output" =~ 'names "sum"' && "$output" =~ ", sums," ]]
  [ ! -e wrong.png ]
}

@test "what is named is drawn until its errors are within the tolerance, whatever the maps err by" {
  render-osmesa -q $scene --effects auto,+rays --tolerance 6 -o out.exr --report r.json
  [ "$(of decision shadow)" = "forced on" ]
  jq -e '.results.rays | .reached and .error_de00_p95 <= 6 and .noise_de00_p95 <= .error_de00_p95' r.json
}

@test "a time limit ends the samples, which is told, and the picture is written" {
  run render-osmesa $scene --effects auto,+rays --tolerance 0.01 --time-limit 1 -o limited.exr --report r.json
  [ "$status" -eq 4 ]
  [[ $output == *", more than 0.01"* ]]
  jq -e '.results.rays.reached == false' r.json
  [ -s limited.exr ]
}

@test "a time limit that is too short for all pixels draws fewer, and says so" {
  shot="${scene/48x36/480x270} --effects auto,+rays"
  run render-osmesa $shot --time-limit 0.01 --aov normal -o short.exr --report r.json
  [ "$status" -eq 0 ]
  [[ $output == *"warning: --time-limit 0.01 is too short for 480 x 270 pixels: the picture is enlarged from 160 x 90"* ]]
  jq -e '.results.enlarged_from == {width: 160, height: 90} and .results.rays.samples > 0' r.json
  # An asked tolerance is missed, whatever the small picture errs by.
  run render-osmesa -q $shot --time-limit 0.01 --tolerance 90 -o missed.exr
  [ "$status" -eq 4 ]
  # Pictures of a sequence have as many pixels as its first.
  render-osmesa -q $shot --time-limit 0.01 --turntable 2 -o turn.exr
  # With time for all, every pixel is drawn. Buffers have all of them in either case.
  render-osmesa -q $shot --time-limit 60 --tolerance 8 --aov normal -o whole.exr --report r.json
  jq -e '.results | has("enlarged_from") | not' r.json
  oiiotool short.exr --ch normal.X,normal.Y,normal.Z whole.exr --ch normal.X,normal.Y,normal.Z --diff
  # The small picture is the whole one without its details: the means are the same.
  mean() { oiiotool "$1" --ch R,G,B --printstats | awk '/Stats Avg/ { print $3 }'; }
  awk -v a="$(mean short.exr)" -v b="$(mean whole.exr)" 'BEGIN { exit !(a > 0 && a / b < 1.05 && b / a < 1.05) }'
  for picture in short.exr turn-0001.exr turn-0002.exr; do oiiotool --info "$picture" | grep -q '480 x  270'; done
}

@test "a picture of which nothing is asked costs no more than is said, and what is asked for is not cut" {
  run render-osmesa $scene --explain -o out.exr --report r.json
  [ "$status" -eq 0 ]
  [[ $output == *"no tolerance, time limit or check is asked for: rays end after 5 s"* ]]
  jq -e '.results.plan_quick' r.json
  for asked in "--tolerance 0.5" "--time-limit 60" "--effects auto,+rays --tolerance 6"; do
    run render-osmesa $scene --explain $asked -o out.exr --report r.json
    [ "$status" -eq 0 ] || [ "$status" -eq 4 ]
    [[ $output != *"rays end after"* ]]
    jq -e '.results.plan_quick | not' r.json
  done
}

@test "few points of a surface stand out from those beside them" {
  # Walls of which the box takes about half of the light: whether its rest is summed is decided alike by neighbors.
  render-osmesa -q ${scene/48x36/240x180} --effects auto,+rays --tolerance 4 -o box.exr
  oiiotool box.exr --ch R,G,B -o box3.exr --median 3x3 -o median.exr
  run oiiotool box3.exr median.exr --warn 0.02 --fail 0.02 --diff
  count=$(sed -nE 's/^ *([0-9]+) pixels .* over 0.02/\1/p' <<<"$output" | tail -1)
  [ "$count" -lt 860 ]
}

@test "the mesh stands on the floor of the environment where that is the background" {
  render-osmesa -q $scene --tolerance 2 -o out.exr --report r.json
  [ "$(of needed floor)" = false ]
  [[ $(of reason floor) == *"no floor is asked for"* ]]
  for engine in cpu gl; do
    render-osmesa -q $scene --tolerance 2 --engine $engine --background env -o $engine.exr --report r.json
    [ "$(of decision floor)" = drawn ]
    awk -v worth="$(of de00_p95 floor)" 'BEGIN { exit !(worth > 1) }'
  done
  # Beside the box the floor is that of the engine path: their mean difference is small against the floor's own share.
  render-osmesa -q $scene --engine path --tolerance 1 --background env -o path.exr
  render-osmesa -q $scene --tolerance 2 --background env --floor none -o none.exr
  for picture in cpu gl none; do
    oiiotool path.exr --ch R,G,B $picture.exr --ch R,G,B --absdiff --cut 10x24+38+12 --printstats |
      awk '/Stats Avg/ { print $4 }' >$picture.txt
  done
  awk -v a="$(cat cpu.txt)" -v b="$(cat gl.txt)" -v c="$(cat none.txt)" 'BEGIN { exit !(a < 0.35 * c && b < 0.35 * c) }'
}

@test "the floor is drawn by name whatever it is worth, and the check sees it" {
  run render-osmesa -q $scene --tolerance 60 --floor shadow --check 30 -o out.exr --report r.json
  [ "$status" -eq 0 ]
  [ "$(of decision floor)" = "forced on" ]
  jq -e '.results.error | .against == "truth" and .de00_p95 < 60' r.json
  render-osmesa -q $scene --tolerance 4 --background env --floor shadow --check 30 -o out.exr --report r.json || [ $? -eq 1 ]
  jq -e '.results.error | .occlusion < 1e-6 and .bounce < 2.1' r.json
}

@test "the check tells what the floor is worth, as the first pass tells it" {
  render-osmesa -q $scene --engine cpu --tolerance 8 --background env --check 120 -o out.exr --report r.json || [ $? -eq 1 ]
  jq -e --argjson plan "$(of de00_p95 floor)" '.results.error.worth.floor | . > 1 and $plan < 1.3 * . and . < 1.3 * $plan' r.json
  # The control has none.
  render-osmesa -q $scene --engine cpu --tolerance 20 --check 40 -o out.exr --report r.json || [ $? -eq 1 ]
  jq -e '.results.error.worth | .floor == 0 and .shadow > 1' r.json
}

@test "from below the floor is left out, and above the lowest point of the mesh only rays alone draw it" {
  run render-osmesa $scene --tolerance 2 --floor shadow --camera 0,-9,9,0,0,0,30 -o out.exr --report r.json
  [ "$status" -eq 0 ]
  [[ $output == *"is below the floor, which is left out"* ]]
  [ "$(of needed floor)" = false ]
  run render-osmesa -q $scene --engine cpu --floor shadow,0.1 -o none.exr
  [ "$status" -eq 2 ]
  [[ $output == *"--engine path hides what is below"* ]]
  render-osmesa -q $scene --tolerance 4 --floor shadow,0.1 -o out.exr --report r.json
  [ "$(jq -r .results.engine r.json)" = path ]
}

@test "forced off they cost nothing and change nothing" {
  render-osmesa -q $scene --effects auto,-rays -o before.png
  render-osmesa -q $scene --effects auto,+rays,-shadow -o after.png --report r.json
  [ "$(of decision shadow)" = "forced off" ]
  [ "$(of decision bounce)" = "forced off" ]
  [ "$(jq .results.rays r.json)" = null ]
  oiiotool before.png after.png --diff
}

@test "--check compares with truth, tells the difference by its causes, and ends with 1 over the tolerance" {
  run render-osmesa $scene --effects all,-shadow --check 40,truth -o out.exr --report r.json
  [ "$status" -eq 1 ]
  jq -e '.results.error | .against == "truth" and .occlusion > 1 and .noise == 0 and .standard_error < 0.1 * .de00_p95' r.json
  [[ $output == *"farther from the reference than --tolerance 1"* ]]
  jq '.results.error.occlusion' r.json >without
  # The remaining difference is noise, whose standard deviation is within half of the tolerance at 95 of 100 points.
  run render-osmesa -q $scene --effects all,+rays --tolerance 3 --check 40 -o out.exr --report r.json
  [ "$status" -le 1 ]
  jq -e --argjson without "$(cat without)" \
    '.results.error | .against == "truth" and .occlusion < 1e-6 and .bounce < 1e-6 and .noise < 6 and .de00_p95 < 0.5 * $without' r.json
  # The model knows nothing of the mesh, and is compared with what the picture is without it.
  render-osmesa -q $scene --tolerance 2 --check 40,model -o out.exr --report r.json || [ $? -eq 1 ]
  jq -e '.results.error.de00_p95' r.json >drawn
  render-osmesa -q $scene --effects auto,-rays --tolerance 2 --check 40 -o out.exr --report r.json || [ $? -eq 1 ]
  jq -e --argjson drawn "$(cat drawn)" '.results.error | .against == "model" and (.de00_p95 - $drawn | fabs) < 2' r.json
}

@test "buffers without their mesh say so" {
  render-osmesa -q $scene --effects auto,-rays --aov normal,part -o view.exr
  render-osmesa -q --gbuffer view.exr -p fitted.xml#signal_white --env small.env.exr -o out.exr --report r.json
  [[ $(of reason shadow) == *"without their mesh"* ]]
  # A part of a picture has the rays of the whole in its header, by which it would be lit from elsewhere.
  oiiotool view.exr --cut 24x18+12+9 -o cut.exr
  run render-osmesa --gbuffer cut.exr -p fitted.xml#signal_white --env small.env.exr -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" == *"its rays are those of another size than 24 x 18"* ]]
}

@test "a name that is no effect of rays is refused" {
  run render-osmesa $scene --effects auto,+shadows -o none.exr
  [ "$status" -eq 2 ]
  [[ $output == *"shadow, rays, and single lobes"* ]]
}

@test "glass is seen through, by every engine that can, and refused by name by the others" {
  cat >case.obj <<'OBJ'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v -1.5 -1.5 .5
v 1.5 -1.5 .5
v 1.5 1.5 .5
v -1.5 1.5 .5
o Picture
f 1 2 3 4
o Window
f 5 6 7 8
OBJ
  local view="--mesh case.obj -p fitted.xml#signal_white --env small.env.exr --camera 0,0,6,0,0,0 --size 32x32 --samples 1"
  # behind FILE: the red of the middle, where the picture is.
  behind() { oiiotool "$1" --cut 8x8+12+12 --printstats | sed -nE 's/.*Stats Avg: +([-0-9.e+]+) .*/\1/p'; }
  render-osmesa -q $view --part Window=glass --effects all,-rays -o glass.exr --report r.json
  [ "$(of decision panes)" = drawn ]
  [ "$(jq -r '.results.parts[1].paint' r.json)" = glass ]
  render-osmesa -q $view --part Window=glass --engine integral -o integral.exr
  render-osmesa -q $view --part Window=glass --engine path --tolerance 2 -o path.exr
  render-osmesa -q $view --effects all,-rays -o wall.exr --report r.json
  [ "$(of needed panes)" = false ]
  awk -v glass="$(behind glass.exr)" -v integral="$(behind integral.exr)" \
    'BEGIN { exit !(glass > 0 && (glass - integral) ^ 2 < (.02 * glass) ^ 2) }'
  run render-osmesa $view --part Window=glass --engine gl -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "the engine gl does not draw what lies behind panes: take the engine cpu or path" ]]
  run render-osmesa $view --part Window=glas -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "for glass that is seen through write PART=glass" ]]
  run render-osmesa $view --part Window=glass --texture "Window=$TESTDATA/wood.sbrdf.exr,project=box" -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" == *'makes "Window" glass, which has no place for a texture: leave out one of both'* ]]
  run render-osmesa $view --part Window=glass --emit Window=1,1,1 --engine path -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" == *'--emit makes "Window" shine, and --part makes it glass'* ]]
  run render-osmesa $view --part Window=glass --aov transport -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "holds the light of one surface a pixel" ]]
  render-osmesa -q $view --aov normal,aspecular,lambert,mask,part -o view.exr
  run render-osmesa --gbuffer view.exr --env small.env.exr -p fitted.xml#signal_white --part Window=glass -o x.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--gbuffer does not hold what lies behind it: give --mesh" ]]
  # A stream of paints shows each of them through the glass.
  render-osmesa -q ${view/signal_white/s*} --part Window=glass -o '{name}.png'
  [ "$(ls s*.png | wc -l)" -ge 2 ]
}
