# render-osmesa on a machine without OSMesa.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  # Another library under the name of OSMesa hides it, and has none of its functions.
  mkdir hidden
  ln -s "$(ldconfig -p | awk '$1 == "libz.so.1" { print $NF; exit }')" hidden/libOSMesa.so.8
  view="--mesh $TESTDATA/speed-shape.obj --light 30,50 --size 160x90 --effects auto,-rays"
}

without() { LD_LIBRARY_PATH=$PWD/hidden "$@"; }

@test "the engine cpu draws what rays find visible, and it is the same picture" {
  run without render-osmesa $view -o without.exr --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ "libOSMesa.so.8 of Mesa 22 or later cannot be loaded: install libosmesa6" ]]
  [[ "$output" =~ "rays find what is visible" ]]
  [ "$(jq -r .results.engine r.json)" = cpu ]
  [ "$(jq .results.opengl r.json)" = null ]
  render-osmesa -q $view --engine cpu -o with.exr --report w.json
  [ "$(jq .results.opengl w.json)" != null ]
  # Where a rasterizer rounds the corners of triangles to parts of a pixel, single pixels at edges differ.
  oiiotool with.exr --ch R,G,B without.exr --ch R,G,B --absdiff --printstats |
    awk '/Stats Avg/ { exit !($3 < 1e-3 && $4 < 1e-3 && $5 < 1e-3) }'
}

@test "--engine gl says what to install" {
  run without render-osmesa $view --engine gl -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "install libosmesa6" ]]
  [ ! -e none.exr ]
}

@test "streams are drawn too" {
  run without render-osmesa -q $view --basis "$TESTDATA/b5.basis.xml" --paint "$TESTDATA/paints.paints.xml#candy*" -o '{name}.png'
  [ "$status" -eq 0 ]
  [ -e candy_red.png ]
}
