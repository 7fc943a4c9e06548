# Light in bands of wavelength from the outside: what is drawn in them, what lacks a spectrum, and what is refused.
bats_require_minimum_version 1.5.0

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  # A closed box of 2 x 2 x 2 about the origin, whose lid is a part of its own.
  cat >box.obj <<'OBJ'
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
o Walls
f 1 4 3 2
f 5 6 7 8
f 1 5 8 4
f 2 3 7 6
f 1 2 6 5
o Lid
f 4 8 7 3
OBJ
  # A reflectance of 0.8 from 600 nm on and of 0.2 below, at 45as45; the same paint with its three channels alone is bare.
  spectrum=$(for nm in $(seq 400 10 700); do [ "$nm" -ge 600 ] && echo 0.8 || echo 0.2; done | tr '\n' ' ')
  cat >spectra.xml <<XML
<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="red">
<measurement illuminant="D65" observer="10"><lab geometry="45as45" L="60" a="40" b="30"/>
<spectrum geometry="45as45" from="400" to="700" step="10">$spectrum</spectrum></measurement></paint></paints>
XML
  paint-convert --illuminant D65 --observer 2 spectra.xml -o red.xml
  echo '<basis xmlns="urn:goniochrome:basis:1" name="matt"><exponent>1</exponent></basis>' >matt.basis.xml
  fit-paint -q --basis matt.basis.xml red.xml -o fitted.xml
  python3 - <<'PY'
import re
text = open("fitted.xml").read()
paint = re.search(r"<paint name.*</paint>", text, re.S).group(0)
bare = re.sub(r"<spectrum.*?</spectrum>", "", paint, flags=re.S).replace('name="red"', 'name="bare"', 1)
open("paints.xml", "w").write(text.replace(paint, paint + bare))
PY
  printf 'nm,green,warm\nset,held,held\n400,0,0.1\n500,1,0.4\n550,1,0.6\n600,0.1,0.9\n700,0,1.5\n' >table.csv
  printf 'nm,a\n450,1\n700,1\n' >short.csv
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  ln -sf "$BATS_FILE_TMPDIR"/*.{obj,xml,csv} .
  box="--mesh box.obj --paint paints.xml#red --camera 0,0,0,0,-1,-0.6,60 --size 12x12 --samples 1 --bounces 200"
}

result() { python3 -c 'import json, sys; print(eval("r" + sys.argv[1], {"r": json.load(open("r.json"))["results"]}))' "$1"; }
holds() { awk "BEGIN { exit !($1) }" || { echo "not so: $1"; return 1; }; }
# mean R G B of a picture
mean() { oiiotool "$1" --ch R,G,B --printstats | sed -nE 's/.*Stats Avg: ([^ ]+) ([^ ]+) ([^ (]+).*/\1 \2 \3/p'; }

@test "a furnace of known spectrum shows e/(1 - r) in each band; three channels do not" {
  render-osmesa -q $box --emit Walls=D65 --emit Lid=D65 --spectral on --tolerance 0.5 --report r.json -o bands.exr
  [ "$(result "['spectral']['bands']")" = 31 ]
  [ "$(result "['spectral']['observer_deg']")" = 2 ]
  [ "$(result "['engine']")" = path ]
  holds "$(result "['spectral']['readings_de00']") < 0.1"
  render-osmesa -q $box --emit Walls=D65 --emit Lid=D65 --spectral off --operator none --tolerance 0.5 --report r.json -o channels.exr
  [ "$(result ".get('spectral')")" = None ]
  # 1/(1 - 0.2) below 600 nm and 1/(1 - 0.8) above: 1.25 + 3.75 times the share of each channel that lies above. That share
  # follows from the color of the paint itself, 0.2 + 0.6 times the share.
  read -r r g b <<<"$(sed -nE 's/.*<diffuse r="([^"]*)" g="([^"]*)" b="([^"]*)".*/\1 \2 \3/p' paints.xml | head -1)"
  read -r seen_r seen_g seen_b <<<"$(mean bands.exr)"
  for channel in "$r $seen_r" "$g $seen_g" "$b $seen_b"; do
    read -r weight seen <<<"$channel"
    awk -v w="$weight" -v s="$seen" \
      'BEGIN { t = 1.25 + 3.75 * (w * 3.14159265 - 0.2) / 0.6; d = s / t - 1; print w, s, t; exit !(d * d < 0.0004) }'
  done
  read -r plain _ <<<"$(mean channels.exr)"
  holds "$plain < 0.9 * $seen_r"
}

@test "what lacks a spectrum is told, and the picture has three channels" {
  run --separate-stderr render-osmesa $box --part Lid=paints.xml#bare --emit Walls=A --tolerance 2 --report r.json -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'three channels, not in bands: the paint bare: it has no spectrum'* ]]
  [ "$(result "['spectral']['bands']")" = 0 ]
  [ "$(result "['spectral']['lacks'][0]")" = 'the paint bare: it has no spectrum' ]
  run --separate-stderr render-osmesa $box --emit Walls=A --emit Lid=1,1,1 --tolerance 2 -o a.exr
  [[ "$stderr" == *'--emit Lid is three numbers'* ]]
  run --separate-stderr render-osmesa $box --emit Walls=A --emit Lid=1,1,1 --spectral on --tolerance 2 -o none.exr
  [ "$status" -eq 3 ]
  [ ! -e none.exr ]
  [[ "$stderr" == *'--spectral on needs spectra of all: --emit Lid is three numbers'* ]]
}

@test "guess takes the smoothest spectrum for what states none, and says for what" {
  run --separate-stderr render-osmesa $box --part Lid=paints.xml#bare --emit Walls=A --emit Lid=1,1,1 --spectral guess \
    --tolerance 2 --report r.json -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'the paint bare: it has no spectrum'* ]]
  [ "$(result "['spectral']['bands']")" = 31 ]
  [ "$(result "['spectral']['lacks']")" = '[]' ]
  [ "$(result "['spectral']['guessed']")" = "['the paint bare: it has no spectrum', '--emit Lid is three numbers']" ]
  # A colored lamp alone has its color; red paint in it is red by the overlap of the two spectra, not by --operator.
  cyan="--mesh box.obj --emit Lid=0,1,1 --spectral guess --camera 0,0,0,0,-1,-0.6,60 --size 8x8 --samples 1 --bounces 1 --tolerance 2"
  render-osmesa -q $cyan --paint paints.xml#bare -o cyan.exr
  read -r red green _ <<<"$(mean cyan.exr)"
  holds "$red > 0.02 * $green"
  run --separate-stderr render-osmesa $box --emit Walls=A --env "$TESTDATA/studio.exr" --spectral guess -o none.exr
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'--spectral guess needs spectra of all: the environment has three channels'* ]]
}

@test "auto draws in bands and says so; three numbers alone say nothing" {
  run --separate-stderr render-osmesa $box --emit Walls=A --tolerance 2 --explain --report r.json -o a.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'light: 31 bands from 400 to 700 nm, for the observer of 2 deg'* ]]
  run --separate-stderr render-osmesa $box --emit Walls=1,1,1 --tolerance 2 --explain --report r.json -o a.exr
  [[ "$stderr" != *bands* ]]
  [ "$(result ".get('spectral')")" = None ]
}

@test "lamps are named with factors, filters and columns of tables" {
  scene="--mesh box.obj --paint paints.xml#red --camera 0,0,0,0,-1,-0.6,60 --size 8x8 --samples 1 --bounces 0 --tolerance 0.5"
  render-osmesa -q $scene --light place:0,0.3,0,D65@5 --spectral on -o one.exr
  render-osmesa -q $scene --light place:0,0.3,0,D65*3@5 --spectral on -o three.exr
  read -r one _ <<<"$(mean one.exr)"
  read -r three _ <<<"$(mean three.exr)"
  holds "$three > 2.9 * $one && $three < 3.1 * $one"
  render-osmesa -q $scene --light "place:0,0.3,0,D65*table.csv#green*2@5" --spectral on -o green.exr
  read -r r g _ <<<"$(mean green.exr)"
  holds "$g > $r"
  render-osmesa -q $scene --light "place:0,0.3,0,table.csv#warm@5" --spectral on -o warm.exr
  read -r r g _ <<<"$(mean warm.exr)"
  holds "$r > 2 * $g"
}

@test "bad lights are refused by name" {
  refused() { # STATUS TEXT ARGUMENTS...
    run --separate-stderr render-osmesa $box "${@:3}" -o refused.exr
    [ "$status" -eq "$1" ] && [[ "$stderr" == *"$2"* ]] && [ ! -e refused.exr ] && return 0
    echo "status $status, not $1; $stderr"
    return 1
  }
  refused 2 'is no light: write three numbers, one of D65' --emit Walls=moon
  refused 2 'is no filter' --emit Walls=D65*moon
  refused 3 'there is no spectrum "blue": there are green, warm' --emit 'Walls=table.csv#blue'
  refused 3 'from 400 to 700' --emit "Walls=short.csv#a"
  refused 2 'light cannot be negative' --emit Walls=D65*-1
  refused 2 'is given twice' --light 30,40,1,1,1,D65
  refused 2 '--spectral' --light 30,40,D65 --spectral on --engine cpu
  run --separate-stderr render-osmesa $box --light 30,40,D65 --engine cpu -o cpu.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'light has three channels'* ]]
}
