# paint-export from the outside: its files by readers of their own, names, reports, exit statuses.

bats_require_minimum_version 1.5.0

setup_file() {
  export SIX=arctic_white,silver_fine,candy_red,olive_matte,steel_blue,jet_black
  fit-paint -q -b "$TESTDATA/b7.basis.xml" --satin none "$TESTDATA/paints.paints.xml#$SIX" -o "$BATS_FILE_TMPDIR/fitted.xml"
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  fitted=$BATS_FILE_TMPDIR/fitted.xml
  readers=$BATS_TEST_DIRNAME/readers
}

# read_back TARGET ENDING [NAMES]: the independent reader finds the differences that the tool told, to a tenth or 0.05.
read_back() {
  local names=${3:-$SIX}
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  paint-export -q --to "$1" "$fitted#$names" --report r.json >told.tsv
  jq -r '.results.paints[] | "\(.name) \(.de00_mean) \(.de00_max)"' r.json >told
  # shellcheck disable=SC2046
  /usr/bin/python3 "$readers/compare.py" "$fitted" $(awk -v ending="$2" '{ print $1, $1 "." ending }' told) >found
  paste -d ' ' told found >both
  cat both
  [ "$(wc -l <both)" -eq "$(wc -w <<<"${names//,/ }")" ]
  ! grep -i nan both || false
  awk 'function near(a, b) { d = a - b; if (d < 0) d = -d; return d <= 0.05 + 0.1 * a } !near($2, $4) || !near($3, $5) { bad = 1 } END { exit bad }' both
}

@test "a table for Mitsuba reads back as told, within 0.3 dE00 in the mean" {
  read_back rgl bsdf
  awk '$2 > 0.3 { exit 1 }' both
  # Our own reader of measured BRDFs takes it.
  paint-convert -q silver_fine.bsdf --to csv -o silver.csv
  [ "$(wc -l <silver.csv)" -gt 5 ]
}

# Half vectors near 90 deg once stood for the light of the mirror direction, where the viewer stands on the normal; then a
# renderer sent 996 of 1000 samples below the horizon.
@test "a table for Mitsuba sends samples where light is, also for viewers on the normal" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  paint-export -q --to rgl "$fitted" >/dev/null
  /usr/bin/python3 - "$readers" ./*.bsdf <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import rgl
shares = [(rgl.share_above_horizon(path, viewer), viewer, path) for path in sys.argv[2:] for viewer in (0, 1, 12)]
print(*shares, sep="\n")
assert min(shares)[0] > 0.98
PY
}

# red_paint: matt.xml, a reflectance of 0.8 from 600 nm on and of 0.2 below, at 45as45, on a matt paint.
red_paint() {
  spectrum=$(for nm in $(seq 400 10 700); do [ "$nm" -ge 600 ] && echo 0.8 || echo 0.2; done | tr '\n' ' ')
  cat >red.xml <<XML
<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="red">
<measurement illuminant="D65" observer="10"><lab geometry="45as45" L="60" a="40" b="30"/>
<spectrum geometry="45as45" from="400" to="700" step="10">$spectrum</spectrum></measurement></paint></paints>
XML
  echo '<basis xmlns="urn:goniochrome:basis:1" name="matt"><exponent>1</exponent></basis>' >matt.basis.xml
  paint-convert -q --illuminant D65 --observer 2 red.xml -o lit.xml
  fit-paint -q --basis matt.basis.xml --coat none lit.xml -o matt.xml
}

@test "a spectral table has the spectrum of the paint, and a paint without one is told so" {
  red_paint
  paint-export --to rgl-spectral matt.xml -o red.bsdf --report r.json
  jq -e '.results.paints[0].de00_mean < 0.3' r.json
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  /usr/bin/python3 - "$readers" <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import numpy
import rgl
file = rgl.fields("red.bsdf")
assert list(file["wavelengths"]) == list(range(400, 701, 10))
f = rgl.reflection("red.bsdf", numpy.array([(-0.5 ** 0.5, 0, 0.5 ** 0.5)]), numpy.array([(0.0, 0, 1)]))[0]
print(numpy.pi * f)
assert abs(numpy.pi * f - numpy.where(file["wavelengths"] >= 600, 0.8, 0.2)).max() < 0.01
PY
  # Our own reader sees the same Lab under the light of the readings.
  paint-convert -q --illuminant D65 --observer 2 red.bsdf --to csv -o - | grep -E '^red,45as45,' >ours
  paint-convert -q matt.xml --to csv -o - | grep -E '^red,45as45,' >true
  paste -d, ours true | tee /dev/stderr | awk -F, '{ for (i = 5; i <= 7; ++i) { d = $i - $(i + 7); if (d * d > 0.04) exit 1 } }'
  run --separate-stderr paint-export -q --to rgl-spectral "$fitted#candy_red" -o x.bsdf
  [ "$status" -eq 3 ]
  [[ "$stderr" = *'"candy_red": '*spectr* ]]
}

@test "a material of MDL and its table read back as told, within 0.3 dE00 in the mean" {
  read_back mdl mdl
  awk '$2 > 0.3 { exit 1 }' both
  [ "$(jq -r '.results.paints[0].companion' r.json)" = arctic_white.mbsdf ]
  # Our own reader of measured BRDFs takes the table.
  paint-convert -q silver_fine.mbsdf --to csv -o silver.csv
  [ "$(wc -l <silver.csv)" -gt 5 ]
  # The second file follows the name of the first, and there is no place for it on standard output.
  paint-export -q --to mdl "$fitted#jet_black" -o 'my-{name}' >/dev/null
  grep -F '"./my-jet_black.mbsdf"' my-jet_black.mdl
  [ -s my-jet_black.mbsdf ]
  for wrong in - black.mbsdf; do
    run paint-export -q --to mdl "$fitted#jet_black" -o $wrong
    [ "$status" -eq 2 ]
  done
}

# A table has no light below 0, and a renderer that works in Rec.709 no other primaries.
@test "a table of MDL in ACEScg holds a paint that one in Rec.709 cuts, and says so" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  fit-paint -q -b "$TESTDATA/b7.basis.xml" --satin none "$TESTDATA/paints.paints.xml#candy_blue" -o blue.xml
  for target in mdl mdl-acescg; do
    run --separate-stderr paint-export --to $target blue.xml -o $target.mdl --report $target.json
    [ "$status" -eq 0 ]
    read -r mean worst < <(/usr/bin/python3 "$readers/compare.py" blue.xml candy_blue $target.mdl)
    jq -e --argjson mean "$mean" --argjson worst "$worst" \
      '.results.paints[0] | (.de00_mean - $mean | fabs) <= 0.05 + 0.1 * .de00_mean and (.de00_max - $worst | fabs) <= 0.05 + 0.1 * .de00_max' $target.json
    [ $target = mdl-acescg ] || [[ "$stderr" = *"candy_blue: the part of its colors outside of Rec.709 is left out"* ]]
  done
  jq -e '.results.paints[0] | .de00_mean < 4 and (.left_out | length) == 1' mdl.json
  jq -e '.results.paints[0] | .de00_mean < 0.3 and (.left_out | length) == 0' mdl-acescg.json
  grep -F 'works in ACEScg' mdl-acescg.mdl
  # Our own reader knows the space of the table.
  paint-convert -q mdl-acescg.mbsdf --to csv -o - | tail -n +2 | cut -d, -f2,5-7 | sort >table.csv
  paint-convert -q --illuminant D65 --observer 2 blue.xml --to csv -o - | tail -n +2 | cut -d, -f2,5-7 | sort >paint.csv
  join -t, table.csv paint.csv | tee /dev/stderr | awk -F, '{ ++n; for (i = 2; i <= 4; ++i) { d = $i - $(i + 3); if (d * d > 16) exit 1 } } END { exit !n }'
}

@test "a graph of MaterialX reads back as told, within 1 dE00 for each of the six" {
  read_back materialx mtlx
  awk '{ print $1, $4 } $4 > 1 { exit 1 }' both
  xmllint --noout ./*.mtlx
}

@test "the parameters of Standard Surface read back as told" {
  read_back standard-surface mtlx
  xmllint --noout ./*.mtlx
}

@test "the parameters of OpenPBR read back as told, from MaterialX and from USD" {
  read_back openpbr mtlx
  xmllint --noout ./*.mtlx
  read_back openpbr-usda usda
  # Both files have the same parameters.
  [ "$(grep -o 'name="specular_ior"[^/]*' silver_fine.mtlx | grep -o '[0-9.]*' )" = "$(grep -o 'specular_ior = .*' silver_fine.usda | grep -o '[0-9.]*')" ]
}

# Interference turns the hue beyond Rec.709, and the graph keeps it in a space that has it.
@test "a paint outside of Rec.709 is in ACEScg, and reads back as told" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  fit-paint -q -b "$TESTDATA/b7.basis.xml" --satin none "$TESTDATA/paints.paints.xml#candy_blue" -o blue.xml
  paint-export -q --to materialx blue.xml -o blue.mtlx --report r.json >/dev/null
  grep -F 'colorspace="acescg"' blue.mtlx
  read -r mean worst < <(/usr/bin/python3 "$readers/compare.py" blue.xml candy_blue blue.mtlx)
  jq -e --argjson mean "$mean" --argjson worst "$worst" \
    '.results.paints[0] | (.de00_mean - $mean | fabs) < 0.05 and (.de00_max - $worst | fabs) < 0.1 and .de00_mean < 2' r.json
  paint-export -q --to materialx "$fitted#silver_fine" -o silver.mtlx >/dev/null
  grep -F 'colorspace="lin_rec709"' silver.mtlx
}

@test "the parameters of glTF read back as told" {
  read_back gltf gltf
  jq -e '.asset.version == "2.0" and .materials[0].name == "candy_red"' candy_red.gltf
  # A film brings a metallic paint nearer, and a solid one has none.
  jq -e '.extensionsUsed | index("KHR_materials_iridescence")' candy_red.gltf
  jq -e '.extensionsUsed | index("KHR_materials_iridescence") | not' jet_black.gltf
}

@test "the parameters of the Enterprise PBR Shading Model read back as told" {
  read_back enterprise dspbr.gltf
  jq -e '.materials[0] | .name == "candy_red" and .extras.shading_model == "Enterprise PBR Shading Model 2022x"' candy_red.dspbr.gltf
  # An index of refraction is at least 1, and a tint at most 1.
  jq -es 'all(.[].materials[0].extensions; .KHR_materials_ior.ior >= 1 and (.KHR_materials_specular.specularColorFactor | max <= 1))' ./*.dspbr.gltf
}

@test "the parameters of UsdPreviewSurface read back as told" {
  read_back usda usda
}

@test "the tree for Radiance reads back as told" {
  read_back radiance xml
  awk '{ sum += $2 } $2 > 0.35 { exit 1 } END { exit !(sum / NR <= 0.3) }' both
  xmllint --noout --huge ./*.xml
  mv jet_black.xml arctic_white.xml "$BATS_FILE_TMPDIR" # for the library of Radiance
}

@test "a table of OpenMATERIAL has the spectrum of the paint, reads back as told, and names its second file" {
  /usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "python3-numpy is not there"
  red_paint
  paint-export -q --to openmaterial matt.xml -o 'my-{name}' --report r.json
  jq -e '.results.paints[0] | .companion == "my-red_brdf.xompt" and .de00_mean < 0.3' r.json
  /usr/bin/python3 - "$readers" <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import numpy
import openmaterial
nm = openmaterial.table("my-red.xomp")[0]
f = openmaterial.bands("my-red.xomp", numpy.array([(-0.5 ** 0.5, 0, 0.5 ** 0.5)]), numpy.array([(0.0, 0, 1)]))[0]
print(numpy.pi * f)
assert abs(numpy.pi * f - numpy.where(nm >= 6e-7, 0.8, 0.2)).max() < 0.01
PY
  # A gray metallic paint needs no spectrum.
  sed 's/name="red"/name="gray"/; s/a="40" b="30"/a="0" b="0"/; /<spectrum/s/.*<.measurement>/<\/measurement>/' red.xml |
    sed 's|</measurement>|<lab geometry="45as15" L="110" a="0" b="0"/><lab geometry="45as110" L="30" a="0" b="0"/>&|' >gray.xml
  fit-paint -q -b "$TESTDATA/b7.basis.xml" gray.xml -o gray.fit.xml
  paint-export -q --to openmaterial gray.fit.xml -o '{name}.xomp' --report r.json
  read -r mean worst < <(/usr/bin/python3 "$readers/compare.py" gray.fit.xml gray gray.xomp)
  jq -e --argjson mean "$mean" --argjson worst "$worst" \
    '.results.paints[0] | (.de00_mean - $mean | fabs) < 0.05 and (.de00_max - $worst | fabs) < 0.1 and .de00_mean < 0.3' r.json
  # One paint has one identity, and another one another.
  [ "$(jq -r .metadata.uuid gray.xomp)" = "$(jq -r .metadata.uuid gray_brdf.xompt)" ]
  [ "$(jq -r .metadata.uuid gray.xomp)" != "$(jq -r .metadata.uuid my-red.xomp)" ]
  run --separate-stderr paint-export -q --to openmaterial "$fitted#candy_red" -o x
  [ "$status" -eq 3 ]
  [[ "$stderr" = *'"candy_red": '*spectr* ]]
  run paint-export -q --to openmaterial gray.fit.xml -o -
  [ "$status" -eq 2 ]
}

@test "the library of Radiance reads the tree, in color" {
  venv_with pyradiance.bsdf pyradiance
  cd "$BATS_FILE_TMPDIR"
  [ -e arctic_white.xml ] || paint-export -q --to radiance "$fitted#jet_black,arctic_white" >/dev/null
  "$venv/bin/python" -c 'import numpy' 2>/dev/null || "$venv/bin/pip" install -q numpy >/dev/null 2>&1 || skip "pip cannot install the package numpy"
  "$venv/bin/python" - "$readers" <<'PY'
import sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import numpy
import radiance
from compare import XYZ_FROM_REC709, geometries
from shared.colors import de2000, lab
from pyradiance import bsdf
light, view = geometries()
light, view = (rows + (0.003, 0.004, 0) for rows in (light, view))  # off the edges of leaves
light, view = (rows / numpy.linalg.norm(rows, axis=1, keepdims=True) for rows in (light, view))
for name in ("jet_black", "arctic_white"):
    angles = [numpy.degrees((numpy.arccos(d[:, 2]), numpy.arctan2(d[:, 1], d[:, 0]))) for d in (light, view)]
    file = bsdf.load_file(name + ".xml")
    found = numpy.array([bsdf.query(file, *row) for row in numpy.vstack(angles).T])
    own = radiance.xyz(name + ".xml", light, view)
    apart = de2000(lab(numpy.pi * own), lab(numpy.pi * found))
    print(name, apart.max())
    assert apart.max() < 0.05
PY
}

@test "the table, the summary and the report tell the same" {
  run --separate-stderr paint-export --to gltf "$fitted#silver_fine" -o a.gltf --report r.json
  [ "$status" -eq 0 ]
  [ "${lines[0]}" = "$(printf 'name\tfile\tde00_mean\tde00_max\treadings')" ]
  [[ "${lines[1]}" = "$(printf 'silver_fine\ta.gltf\t')"* ]]
  [[ "$stderr" = *"1 paints written for gltf, dE00 mean "* ]]
  [ "$(jq '.results.paints[0].de00_by_geometry | length' r.json)" -eq 17 ]
  jq -e '.results.written == 1 and .results.paints[0].file == "a.gltf" and (.results.paints[0].readings_de00_mean > 0)' r.json
}

@test "a paint on standard output has no table before it" {
  paint-export -q --to materialx "$fitted#jet_black" -o - >black.mtlx
  xmllint --noout black.mtlx
  run paint-export -q --to materialx "$fitted" -o -
  [ "$status" -eq 2 ]
}

# renamed NAME...: paints of these names, from one that is fitted.
renamed() {
  printf '<paints xmlns="urn:goniochrome:paint:1" version="1">\n'
  for name in "$@"; do
    sed -n '/name="jet_black"/,/<\/paint>/p' "$fitted" | NAME=$name perl -pe 's/jet_black/$ENV{NAME}/'
  done
  printf '</paints>\n'
}

@test "names of any kind become names of files, each its own, and stay for people" {
  renamed '../../evil' '9 lives' 'Blau/Grün é' 'a b' 'a_b' 'A.B' '&lt;x&gt; &quot;q&quot;' "$(printf 'n%.0s' {1..300})" >odd.xml
  mkdir here
  paint-export -q --to materialx odd.xml -o 'here/{name}' >/dev/null
  ls here
  [ "$(find here -name '*.mtlx' | wc -l)" -eq 8 ]
  [ "$(find . -name '*evil*')" = ./here/_evil.mtlx ]
  for name in _9_lives Blau_Gr_n_ a_b a_b_2 A_B_3 _x_q_; do [ -e here/$name.mtlx ]; done
  xmllint --noout here/*.mtlx
  [ "$(xmllint --xpath 'string(//surfacematerial/@uiname)' here/Blau_Gr_n_.mtlx)" = 'Blau/Grün é' ]
  [ "$(xmllint --xpath 'string(//surfacematerial/@uiname)' here/_x_q_.mtlx)" = '<x> "q"' ]
  ! xmllint --xpath '//*/@name' here/*.mtlx | grep -oE '"[^"]*"' | grep -vE '^"[A-Za-z_][A-Za-z0-9_]*"$' || false
  paint-export -q --to gltf odd.xml -o 'here/{name}' >/dev/null
  [ "$(jq -r '.materials[0].name' here/Blau_Gr_n_.gltf)" = 'Blau/Grün é' ]
}

@test "a paint without lobes, a folder that is not there, a second paint in one file: errors that say what helps" {
  run --separate-stderr paint-export --to rgl "$TESTDATA/paints.paints.xml#silver_fine" -o a.bsdf
  [ "$status" -eq 3 ]
  [[ "$stderr" = *'"silver_fine" has no lobes: fit it by fit-paint first'* ]]
  run --separate-stderr paint-export -q --to rgl "$fitted#jet_black" -o none/a.bsdf
  [ "$status" -eq 3 ]
  [[ "$stderr" = *none/a.bsdf* ]]
  run --separate-stderr paint-export -q --to gltf "$fitted" -o a.gltf
  [ "$status" -eq 2 ]
  [[ "$stderr" = *"{name}"* ]]
  run paint-export "$fitted" -o a.gltf
  [ "$status" -eq 2 ]
  run paint-export --to axf "$fitted" -o a.axf
  [ "$status" -eq 2 ]
}

@test "--keep-going leaves out what has no lobes" {
  sed 's/<paint name="silver_fine"/&/; /<lobes/,/<\/lobes>/d' "$fitted" | sed 's/name="/name="bare_/' | sed -n '/<paint /,/<\/paint>/p' >bare
  { sed '/<\/paints>/d' "$fitted"; cat bare; echo '</paints>'; } >mixed.xml
  run --separate-stderr paint-export -k --to gltf mixed.xml --report r.json
  [ "$status" -eq 1 ]
  [ "$(jq .results.written r.json)" -eq 6 ]
  [ "$(jq .results.left_out r.json)" -eq 6 ]
  [ "$(jq '.results.warnings | length' r.json)" -eq 6 ]
}

# venv_with MODULE PACKAGE: a Python that has the module, from pip beside the build, or the test is skipped by its name.
venv_with() {
  venv=$BATS_TEST_DIRNAME/../../build/paint-export-checks
  if ! "$venv/bin/python" -c "import $1" 2>/dev/null; then
    { /usr/bin/python3 -m venv "$venv" && timeout 120 "$venv/bin/pip" install -q "$2"; } >/dev/null 2>&1 || skip "pip cannot install the package $2"
  fi
}

@test "the package MaterialX finds the graphs valid, and makes shaders of them" {
  venv_with MaterialX materialx
  paint-export -q --to materialx "$fitted" >/dev/null
  paint-export -q --to standard-surface "$fitted" -o '{name}.standard.mtlx' >/dev/null
  paint-export -q --to openpbr "$fitted" -o '{name}.openpbr.mtlx' >/dev/null
  "$venv/bin/python" - ./*.mtlx <<'PY'
import sys
import MaterialX as mx
import MaterialX.PyMaterialXGenShader as gen
import MaterialX.PyMaterialXGenGlsl as glsl
for path in sys.argv[1:]:
    search = mx.getDefaultDataSearchPath()
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), search, library)
    document = mx.createDocument()
    mx.readFromXmlFile(document, path)
    document.setDataLibrary(library) if hasattr(document, "setDataLibrary") else document.importLibrary(library)
    valid, messages = document.validate()
    assert valid, (path, messages)
    generator = glsl.GlslShaderGenerator.create()
    context = gen.GenContext(generator)
    context.registerSourceCodeSearchPath(search)
    material = document.getMaterialNodes()[0]
    shader = generator.generate(material.getName(), material, context)
    assert ("mx_generalized_schlick_bsdf" if path.count(".") == 2 else "mx_dielectric_bsdf") in shader.getSourceCode("pixel"), path
print(len(sys.argv) - 1, "graphs with MaterialX", mx.getVersionString())
PY
}

@test "the validator of Khronos finds no fault in a glTF file" {
  node=$BATS_TEST_DIRNAME/../../build/paint-export-checks-npm
  command -v npm >/dev/null || skip "npm is not there"
  [ -d "$node/node_modules/gltf-validator" ] || { mkdir -p "$node" && (cd "$node" && timeout 120 npm install --silent gltf-validator) >/dev/null 2>&1; } ||
    skip "npm cannot install the package gltf-validator"
  paint-export -q --to gltf "$fitted" >/dev/null
  paint-export -q --to enterprise "$fitted" >/dev/null
  NODE_PATH=$node/node_modules node -e '
    const validator = require("gltf-validator"), fs = require("fs");
    Promise.all(process.argv.slice(1).map(async path => {
      const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)));
      if (report.issues.numErrors + report.issues.numWarnings) throw JSON.stringify(report.issues.messages.slice(0, 3));
    })).catch(fault => { console.error(String(fault)); process.exit(1); });' ./*.gltf
}

@test "the package usd-core reads the materials, with nothing to complain about" {
  venv_with "pxr.UsdValidation" usd-core
  paint-export -q --to usda "$fitted" >/dev/null
  paint-export -q --to openpbr-usda "$fitted" -o '{name}.openpbr.usda' >/dev/null
  paint-export -q --to usda <(renamed 'Blau/Grün &quot;é&quot; \\n') -o odd.usda >/dev/null
  "$venv/bin/python" - ./*.usda <<'PY'
import sys
from pxr import Usd, UsdShade, UsdValidation
names = []
for path in sys.argv[1:]:
    stage = Usd.Stage.Open(path)
    material = UsdShade.Material(stage.GetDefaultPrim())
    kind, terminal = ("ND_open_pbr_surface_surfaceshader", ["mtlx"]) if "openpbr" in path else ("UsdPreviewSurface", [])
    assert material.ComputeSurfaceSource(*terminal)[0].GetShaderId() == kind, path
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    faults = UsdValidation.ValidationContext(validators).Validate(stage)
    # The package from pip has no nodes of MaterialX in its registry.
    faults = [fault for fault in faults if not (terminal and "not found in sdrRegistry" in fault.GetMessage())]
    assert validators and not faults, (path, [fault.GetMessage() for fault in faults])
    names.append(stage.GetDefaultPrim().GetDisplayName())
assert any(name.startswith('Blau/Grün "é"') for name in names), names
PY
}

@test "an input without paints is told, and is no success" {
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"/>' >none.xml
  run --separate-stderr paint-export none.xml --to usda
  [ "$status" -eq 1 ]
  [[ $stderr == *"the input holds no paints: nothing was exported"* ]]
}
