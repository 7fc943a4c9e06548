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

@test "+rays plans shadow, self and bounce, and draws what is seen" {
  render-osmesa -q $scene -o before.exr --report r.json
  [ -z "$(of decision shadow)" ]
  render-osmesa -q $scene --effects auto,+rays --tolerance 2 -o out.exr --report r.json
  [ "$(of decision shadow)" = drawn ]
  awk -v worth="$(of de00_p95 shadow)" -v error="$(of standard_error shadow)" 'BEGIN { exit !(worth > 1 && error > 0 && error < worth) }'
  [ "$(of needed bounce)" = true ]
  # The noise is within half of the tolerance.
  jq -e '.results.rays.noise_de00_p95 <= 1 and .results.rays.samples > 0' r.json
  ! cmp -s before.exr out.exr
}

@test "forced off they cost nothing and change nothing" {
  render-osmesa -q $scene -o before.png
  render-osmesa -q $scene --effects auto,+rays,-shadow -o after.png --report r.json
  [ "$(of decision shadow)" = "forced off" ]
  [ "$(of decision bounce)" = "forced off" ]
  [ "$(jq .results.rays r.json)" = null ]
}

@test "--check-against truth tells the difference by its causes, and ends with 1 over the tolerance" {
  run render-osmesa $scene --check 40 --check-against truth -o out.exr --report r.json
  [ "$status" -eq 1 ]
  jq -e '.results.error | .against == "truth" and .occlusion > 1 and .noise == 0 and .standard_error < 0.1 * .de00_p95' r.json
  [[ $output == *"farther from the truth than --tolerance 0.5"* ]]
  jq '.results.error.occlusion' r.json >without
  # What is left is noise, whose standard deviation is within half of the tolerance at 95 of 100 points.
  run render-osmesa -q $scene --effects all,+rays --tolerance 3 --check 40 --check-against truth -o out.exr --report r.json
  [ "$status" -le 1 ]
  jq -e --argjson without "$(cat without)" \
    '.results.error | .occlusion < 1e-6 and .bounce < 1e-6 and .noise < 6 and .de00_p95 < 0.5 * $without' r.json
}

@test "buffers without their mesh say so" {
  render-osmesa -q $scene --aov normal,part -o view.exr
  render-osmesa -q --gbuffer view.exr -p fitted.xml#signal_white --env small.env.exr --effects auto,+rays -o out.exr --report r.json
  [[ $(of reason shadow) == *"without their mesh"* ]]
}

@test "a name that is no effect of rays is refused" {
  run render-osmesa $scene --effects auto,+shadows -o none.exr
  [ "$status" -eq 2 ]
  [[ $output == *"rays, shadow, self, bounce"* ]]
}
