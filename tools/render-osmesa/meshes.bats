# Meshes of other programs: glTF 2.0 with nodes, instances and materials, units, and formats that must be converted.

bats_require_minimum_version 1.5.0

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
}

setup() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  view="--light 30,50 --size 96x54 --samples 1"
}

# gltf WORDS: a triangle as glTF 2.0, with these words put behind its version.
gltf() {
  printf '{"asset":{"version":"2.0"},%s"scenes":[{"nodes":[0]}],"nodes":[{"name":"Lid","mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],' "$1"
  printf '"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],'
  printf '"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]}\n'
}

@test "nodes, instances and materials of glTF are parts that are painted by their names" {
  run render-osmesa -q --mesh "$TESTDATA/doors.glb" $view --part Left.Panel=fitted.xml#candy_red --part Pane=fitted.xml#jet_black \
    --paint fitted.xml#silver_fine -o doors.png --report doors.json
  [ "$status" -eq 0 ]
  run jq -c '[.results.parts[] | [.name, .material, .paint]]' doors.json
  [ "$output" = '[["Closet","Steel","silver_fine"],["Left.Panel","Panel","candy_red"],["Left.Pane","Pane","jet_black"],["Right.Panel","Panel","silver_fine"],["Right.Pane","Pane","jet_black"]]' ]
  run jq -c '.results.repairs' doors.json
  [ "$output" = '{"normals_made":0,"degenerate_dropped":0,"polygons_split":0,"triangles_turned":0}' ]
}

@test "a glTF file is the same picture from a pipe, without an ending" {
  render-osmesa -q --mesh "$TESTDATA/doors.glb" $view -o named.exr
  render-osmesa -q --mesh - $view -o piped.exr <"$TESTDATA/doors.glb"
  cmp <(oiiotool named.exr --hash) <(oiiotool piped.exr --hash) || oiiotool named.exr piped.exr --fail 0 --diff
}

@test "a mesh in mm, cm or inches is recognized and told" {
  local scale unit said
  while read -r scale unit said; do
    awk -v s="$scale" '$1 == "v" { printf "v %.9g %.9g %.9g\n", $2 * s, $3 * s, $4 * s; next } { print }' "$TESTDATA/speed-shape.obj" >scaled.obj
    run --separate-stderr render-osmesa --mesh scaled.obj $view -o scaled.exr --report scaled.json
    [ "$status" -eq 0 ]
    [[ "$stderr" =~ "are taken as $said (4." ]]
    jq -e ".results.mesh.unit_m == $unit" scaled.json
  done <<<"1000 0.001 millimeters
100 0.01 centimeters
39.37 0.0254 inches"
  run --separate-stderr render-osmesa --mesh "$TESTDATA/speed-shape.obj" $view -o meters.exr --report meters.json
  [[ ! "$stderr" =~ "taken as" ]]
  jq -e '.results.mesh.unit_m == 1' meters.json
}

@test "glTF that requires what is not known here, USD and STEP are refused, with what to do" {
  gltf '"extensionsRequired":["EXT_of_another_shape"],' >unknown.gltf
  run render-osmesa --mesh unknown.gltf $view -o x.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "\"EXT_of_another_shape\" is not known here: export without it" ]]
  printf '#usda 1.0\n' >car.usda
  printf 'ISO-10303-21;\nHEADER;\n' >car.step
  run render-osmesa --mesh car.usda $view -o x.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "is USD, which is not read here: convert it to glTF, as with: blender -b" ]]
  run render-osmesa --mesh car.step $view -o x.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "convert it to a mesh, as with: gmsh -2 -clcurv 40 car.step -o car.stl" ]]
  run render-osmesa --mesh - $view -o x.exr <car.step
  [ "$status" -eq 3 ]
  [[ "$output" =~ "is STEP" ]]
  gltf "" >whole.gltf
  run render-osmesa -q --mesh whole.gltf $view -o x.exr
  [ "$status" -eq 0 ]
}
