# render-osmesa on machines without OSMesa, without any OpenGL, and without a GPU.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  # Another library under the name of one hides it, and has none of its functions.
  mkdir no-osmesa no-opengl
  other=$(ldconfig -p | awk '$1 == "libz.so.1" { print $NF; exit }')
  ln -s "$other" no-osmesa/libOSMesa.so.8
  ln -s "$other" no-opengl/libOSMesa.so.8
  ln -s "$other" no-opengl/libEGL.so.1
  view="--mesh $TESTDATA/speed-shape.obj --light 30,50 --size 160x90 --effects auto,-rays"
}

without() { LD_LIBRARY_PATH=$PWD/no-opengl "$@"; }
without_osmesa() { LD_LIBRARY_PATH=$PWD/no-osmesa "$@"; }

# far A B: the largest difference of two pictures, or nothing where they are the same.
far() { oiiotool "$1" --ch R,G,B "$2" --ch R,G,B --absdiff --printstats | awk '/Stats Max/ && $3 + $4 + $5 > 0 { print $3, $4, $5 }'; }

@test "pictures need no OpenGL, and those of the engine gl show the same" {
  run without render-osmesa $view --explain -o without.exr --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" != *OpenGL:* ]]
  [ "$(jq -r .results.engine r.json)" = cpu ]
  [ "$(jq .results.opengl r.json)" = null ]
  [ "$(jq .results.opengl_library r.json)" = null ]
  render-osmesa -q $view -o with.exr
  [ -z "$(far with.exr without.exr)" ]
  run render-osmesa -q $view --engine gl -o gl.exr
  [[ "$output" == *"cannot be loaded"* ]] && skip "OpenGL: not installed"
  oiiotool gl.exr --ch R,G,B without.exr --ch R,G,B --absdiff --printstats |
    awk '/Stats Avg/ { exit !($3 < 1e-3 && $4 < 1e-3 && $5 < 1e-3) }'
}

@test "without OSMesa the engine gl draws by the software of EGL, and it is the same picture" {
  run without_osmesa render-osmesa $view --engine gl --explain -o egl.exr --report r.json
  [[ "$output" =~ "EGL has no software renderer" || "$output" =~ "libEGL.so.1 cannot be loaded" ]] && skip "EGL: no software renderer"
  [ "$status" -eq 0 ]
  [[ "$output" =~ "OpenGL: $(jq -r .results.opengl r.json), by EGL" ]]
  [ "$(jq -r .results.opengl_library r.json)" = EGL ]
  run render-osmesa $view --engine gl --explain -o osmesa.exr --report o.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ ", by OSMesa" ]] || skip "OSMesa: not installed"
  [ "$(jq -r .results.opengl_library o.json)" = OSMesa ]
  [ "$(jq .results.opengl r.json)" = "$(jq .results.opengl o.json)" ]
  [ -z "$(far egl.exr osmesa.exr)" ]
  render-osmesa -q $view --engine gl --light -60,50 -o control.exr
  [ -n "$(far egl.exr control.exr)" ]
}

@test "--engine gl says what to install" {
  run without render-osmesa $view --engine gl -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "install libosmesa6, or libegl1 with libegl-mesa0 and libgl1-mesa-dri" ]]
  [ ! -e none.exr ]
}

@test "--engine gpu draws on a GPU and names it, or says that there is none" {
  run render-osmesa $view --engine gpu --explain -o gpu.exr --report r.json
  if [ "$status" -eq 0 ]; then
    [[ "$output" =~ "OpenGL: $(jq -r .results.opengl r.json), by EGL" ]]
    [ "$(jq -r .results.engine r.json)" = gl ]
  else
    [ "$status" -eq 3 ]
    [[ "$output" =~ "there is no GPU that OpenGL can draw on" ]]
    [ ! -e gpu.exr ]
  fi
  run without render-osmesa $view --engine gpu -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "there is no GPU that OpenGL can draw on: libEGL.so.1 cannot be loaded" ]]
}

@test "streams are drawn too" {
  run without render-osmesa -q $view --basis "$TESTDATA/b5.basis.xml" --paint "$TESTDATA/paints.paints.xml#candy*" -o '{name}.png'
  [ "$status" -eq 0 ]
  [ -e candy_red.png ]
}
