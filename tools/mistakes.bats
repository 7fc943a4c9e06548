#!/usr/bin/env bats
# Mistakes that somebody in a hurry makes: an output over an input, a name that is not quite that of a paint, an ending of
# another format. Each is one error that tells what is right, and nothing is lost.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  cp "$TESTDATA/paints.paints.xml" lib.xml
}

# told STATUS WORDS COMMAND...: the command ends with the status, and its message has the words.
told() {
  local wanted=$1 words=$2
  shift 2
  run --separate-stderr timeout -k 1 60 "$@" </dev/null
  [ "$status" -eq "$wanted" ] || { echo "$*: exit $status: $stderr"; return 1; }
  [[ "$stderr" = *"$words"* ]] || { echo "$*: $stderr"; return 1; }
}

@test "an output is not written over the file that a paint, a piece of a list or of an assignment is read from" {
  told 2 "also read" paint-edit lib.xml#candy_red --hue-shift 9 -o lib.xml
  told 2 "also read" paint-convert 'lib.xml#candy*,jet_black' -o ./lib.xml --to xml
  told 2 "also read" paint-stats -q "$TESTDATA/paints.paints.xml" --standard lib.xml#candy_red -o lib.xml
  told 2 "also read" colorsnap -l 'lib.xml#candy*' "$TESTDATA/paints.paints.xml" -o lib.xml
  cmp lib.xml "$TESTDATA/paints.paints.xml"
  cp "$TESTDATA/wood.sbrdf.exr" map.exr
  told 2 "also read" paint-sbrdf "$TESTDATA/brushed.sbrdf.exr" --wear 0.5 --polish map.exr -o map.exr
  told 2 "also read" render-osmesa --mesh "$TESTDATA/speed-shape.obj" --texture 'Hood=map.exr*2,project=box' --light 30,50 -o map.exr
  cmp map.exr "$TESTDATA/wood.sbrdf.exr"
  cp "$TESTDATA/contact-sheet.jpg" sheet.jpg
  told 2 "also read" paint-pick --face sheet.jpg@250,120 -o sheet.jpg
  cmp sheet.jpg "$TESTDATA/contact-sheet.jpg"
  # The control: a file whose name has the sign is another file.
  cp lib.xml lib.xml#candy_red
  told 2 "also read" paint-edit lib.xml#candy_red --hue-shift 9 -o lib.xml#candy_red
  paint-edit -q lib.xml#candy_red --hue-shift 9 -o new.xml
}

@test "drawings beside a result are outputs as well" {
  cp lib.xml lib.svg
  told 2 "also read" colorsnap -l lib.svg "$TESTDATA/paints.paints.xml" --cloud lib.svg -o near.tsv
  cmp lib.svg "$TESTDATA/paints.paints.xml"
  told 2 "--output and --cloud" colorsnap -l lib.xml "$TESTDATA/paints.paints.xml" --cloud out.svg -o out.svg
  told 2 "--error-map and --output" fit-sbrdf "$TESTDATA/capture/photos.csv" --error-map out.exr -o out.exr
  [ ! -e near.tsv ]
  [ ! -e out.svg ]
  [ ! -e out.exr ]
}

@test "a paint that there is not is told with the one that may be meant" {
  local meant='no paint is named "candy_rde": names are taken letter by letter; did you mean "candy_red"?'
  told 3 "lib.xml: $meant" paint-stats lib.xml#candy_rde
  told 3 "$meant" paint-export --to gltf lib.xml#candy_rde
  told 3 "$meant" goniogeom-index lib.xml --only candy_rde
  told 3 "$meant" plot-paint lib.xml -p candy_rde -o none.svg
  told 1 "$meant" paint-edit lib.xml --only candy_red --only candy_rde --gloss 50 -o some.xml
  told 3 'did you mean "candy_red"?' paint-stats lib.xml#Candy_Red
  told 3 'no paint is named "gold": names are taken letter by letter' paint-stats lib.xml#gold
  [[ "$stderr" != *"did you mean"* ]]
}

@test "a word in braces that is none is told, and nothing is drawn" {
  local known='is not known here: there is {name}'
  told 2 "{nme} $known" goniogeom-index lib.xml --only candy_red --mesh "$TESTDATA/speed-shape.obj" --seam Hood,Bumper_F --picture '{nme}.png'
  told 2 "{nme} $known" trompe-fit lib.xml --only candy_red --angle 2 --picture '{nme}.png'
  told 2 "{Name} $known" plot-paint lib.xml -o '{Name}.svg'
  told 2 "{nmae} $known" render-osmesa --mesh "$TESTDATA/speed-shape.obj" --light 30,50 -o '{nmae}.png'
  told 2 "{nme} $known" paint-export --to gltf lib.xml -o 'web-{nme}'
  [ -z "$(find . -name '*{*')" ]
}

@test "every {name} of a pattern is replaced" {
  fit-paint -q -b "$TESTDATA/b5.basis.xml" lib.xml#candy_red | paint-export --to gltf -o '{name}-{name}'
  [ -s candy_red-candy_red.gltf ]
}

@test "a name that ends as another format does is told before the work" {
  told 2 'what is written is an EXR: give a name that ends in .exr' relight --from D65 --to A "$TESTDATA/studio.exr" -o out.png
  told 2 'what is written is an EXR: give a name that ends in .exr' prefilter-envmap -e 4 "$TESTDATA/studio.exr" -o out.hdr
  told 2 'what is written is an EXR: give a name that ends in .exr' prefilter-envmap -e 4 "$TESTDATA/studio.exr" -o out.ktx2
  told 2 'a cube texture of --layout dds: give a name that ends in .dds' prefilter-envmap -e 4 --layout dds "$TESTDATA/studio.exr" -o out.exr
  told 2 'what is written is an EXR' paint-sbrdf "$TESTDATA/wood.sbrdf.exr" --wear 0.5 -o out.PNG
  told 2 'what is written is an EXR' fit-sbrdf "$TESTDATA/capture/photos.csv" -o out.tif
  told 2 'what is written is an SVG or a PNG' plot-paint lib.xml -o out.pdf
  printf 'series,x,y\na,1,2\n' >t.csv
  told 2 'what is written is an SVG: give a name that ends in .svg' draw-plot t.csv -o out.png
  [ -z "$(find . -name 'out.*')" ]
}

@test "an environment that is prefiltered is no image of light" {
  prefilter-envmap -q -e 4 --size 8 "$TESTDATA/studio.exr" -o studio.env.exr
  told 3 "studio.env.exr: is prefiltered already: give the image that it was made from, $TESTDATA/studio.exr" \
    prefilter-envmap -e 4 studio.env.exr -o twice.env.exr
  told 3 'studio.env.exr: is a prefiltered environment' relight --from D65 --to A studio.env.exr -o evening.exr
  [ ! -e twice.env.exr ]
  [ ! -e evening.exr ]
}

@test "a table of points is read as spreadsheets save it" {
  printf '\xef\xbb\xbfseries,x,y\r\na,1,2\r\na,2,3\r\n' >bom.csv
  draw-plot bom.csv -o bom.svg
  printf 'series;x;y\na;1,5;2\na;2;3\n' >semicolons.csv
  printf 'series,x,y\na,1.5,2\na,2,3\n' >commas.csv
  draw-plot semicolons.csv -o semicolons.svg
  draw-plot commas.csv -o commas.svg
  cmp semicolons.svg commas.svg
}

@test "a spectrum below black is told with its place" {
  {
    echo "sample,geometry,400,420,440,460,480"
    echo "p,45as15,-0.5,-0.5,-0.5,-0.5,-0.5"
  } >t.csv
  told 3 't.csv:2: a reflectance factor is -0.5: 0 is black' paint-convert t.csv -o none.xml
  [ ! -e none.xml ]
}
