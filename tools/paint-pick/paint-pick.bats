# paint-pick: droppers, palettes and boards.
bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  # A light left half, a dark right half; signals 0.8 and 0.2.
  oiiotool --create 100x60 3 --fill:color=0.8,0.4,0.4 50x60+0+0 --fill:color=0.2,0.1,0.1 50x60+50+0 -d uint16 -o two.png
}

# Numbers as short as they are: jq 1.7 keeps the digits of the file.
result() { jq -r ".results.$1 | if type == \"number\" then . + 0 else . end" r.json; }
near() { awk -v x="$1" -v y="$2" -v d="$3" 'BEGIN { exit !(x - y <= d && y - x <= d) }' || { echo "$1 is not $2"; return 1; }; }

@test "face and flop are the colors under the droppers" {
  paint-pick -q --face two.png@20,30,4 --flop two.png@80,30 --travel 75 --name dawn -o out.xml --report r.json
  xmllint --noout out.xml
  grep -q '<paint name="dawn">' out.xml
  grep -q 'travel="75"' out.xml
  # sRGB (.8,.4,.4) is Y .2126 .6038 + .7874 .1329 = .2330, L* 55.4; (.2,.1,.1) is Y .0149, L* 12.6.
  near "$(result 'paints[0].face[0]')" 55.4 0.1
  near "$(result 'paints[0].flop[0]')" 12.6 0.1
  [ "$(result 'paints[0].gloss_60_gu')" = null ]
  [ "$(result 'samples[0].pixels')" -eq 49 ] # of the disc of radius 4
}

@test "a disc across an edge is averaged in light, not in signals" {
  # Columns 44..49 are light, 50..54 dark: shares in the disc of radius 5 about column 49: 46 light, 35 dark of 81 pixels.
  paint-pick -q --face two.png@49,30,5 -o out.xml --report r.json
  near "$(result 'samples[0].pixels')" 81 0
  near "$(result 'paints[0].face[0]')" 44.2 0.7 # L* of Y .139; the mean signal has 40.0
  grep -q 'class="solid"' out.xml
}

@test "face and flop trade places where the flop is lighter, unless --retro" {
  run paint-pick --face two.png@80,30 --flop two.png@20,30 -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [[ $output == *"picked: face and flop traded places, for the flop was the lighter one: --retro keeps them"* ]]
  [ "$(result 'paints[0].swapped')" = true ]
  near "$(result 'paints[0].face[0]')" 55.4 0.1
  paint-pick -q --retro --face two.png@80,30 --flop two.png@20,30 -o out.xml --report r.json
  [ "$(result 'paints[0].swapped')" = false ]
  near "$(result 'paints[0].face[0]')" 12.6 0.1
}

@test "gloss_limits: a flat spot has no gloss, a hard contrast has 100" {
  paint-pick -q --face two.png@20,30 --gloss two.png@20,30,6 -o out.xml --report r.json
  near "$(result 'paints[0].gloss_60_gu')" 0 1e-6
  oiiotool --create 40x40 3 --fill:color=1,1,1 20x40+0+0 -o hard.png
  paint-pick -q --face two.png@20,30 --gloss hard.png@20,20,10 -o out.xml --report r.json
  [ "$(result 'paints[0].gloss_60_gu')" = 100 ]
}

@test "a palette has the picture's colors, light and dark" {
  oiiotool --create 90x60 3 \
    --fill:topleft=0.9,0.2,0.2:topright=0.9,0.2,0.2:bottomleft=0.3,0.05,0.05:bottomright=0.3,0.05,0.05 60x60+0+0 \
    --fill:topleft=0.2,0.3,0.9:topright=0.2,0.3,0.9:bottomleft=0.05,0.08,0.3:bottomright=0.05,0.08,0.3 30x60+60+0 -o three.png
  paint-pick -q --palette 2 three.png --name p -o out.xml --report r.json
  [ "$(grep -c '<paint ' out.xml)" -eq 2 ]
  near "$(result 'paints[0].share')" 0.667 0.05
  awk -v r="$(result 'paints[0].face[1]')" -v b="$(result 'paints[1].face[2]')" 'BEGIN { exit !(r > 30 && b < -30) }'
  awk -v f="$(result 'paints[0].face[0]')" -v d="$(result 'paints[0].flop[0]')" 'BEGIN { exit !(f > d + 15) }'
  oiiotool --create 30x30 3 -o black.png
  run paint-pick --palette 5 black.png -o out.xml
  [ "$status" -eq 0 ]
  [[ $output == *"black.png: 1 of 5 paints: the picture has no more colors"* ]]
  [ "$(grep -c '<paint ' out.xml)" -eq 1 ]
  paint-pick -q --palette 8 "$TESTDATA/contact-sheet.jpg" -o a.xml
  paint-pick -q --palette 8 "$TESTDATA/contact-sheet.jpg" -o b.xml --threads 1
  [ "$(grep -v processing a.xml)" = "$(grep -v processing b.xml)" ]
}

write_board() {
  mkdir -p pictures
  cp two.png pictures/
  oiiotool --create 64x48 3 --fill:color=0.1,0.5,0.7 64x48 -o pictures/sea.png
  oiiotool --create 64x48 3 --fill:color=0.9,0.8,0.2 64x48 -o pictures/sand.png
  cat >board.txt <<'EOF'
# three pictures
title Beach & Sea
image rock pictures/two.png
image sea pictures/sea.png
image sand pictures/sand.png

paint Deep Sea
  face sea@10,10,3
  flop rock@80,30
  gloss rock@50,30,8
  travel 45
paint Dune
  face sand@30,20
EOF
}

@test "a board gives its paints" {
  write_board
  paint-pick -q --board board.txt -o out.xml --report r.json
  [ "$(grep -c '<paint ' out.xml)" -eq 2 ]
  [ "$(result 'paints[0].name')" = "Deep Sea" ]
  [ "$(result 'paints[0].travel_deg')" = 45 ]
  [ "$(result 'samples | length')" -eq 4 ]
}

@test "with --studio each paint of the page opens in the studio, by an address that is no markup" {
  write_board
  mkdir -p other
  paint-pick -q --board board.txt -o other/linked.html --studio 'my "studio".html'
  [ "$(grep -o 'href="../my%20%22studio%22.html#design=[^"]*"' other/linked.html | wc -l)" -eq 2 ]
  paint-pick -q --board board.txt -o picked.xml
  python3 - other/linked.html picked.xml <<'PY'
import json, re, sys, urllib.parse
import xml.etree.ElementTree as tree
designs = [json.loads(urllib.parse.unquote(one)) for one in re.findall(r'#design=([^"]*)"', open(sys.argv[1]).read())]
space = "{urn:goniochrome:paint:1}"
for design, paint in zip(designs, tree.parse(sys.argv[2]).getroot().findall(space + "paint"), strict=True):
    assert design["board"] == "board.txt" and design["paint"]["name"] == paint.get("name")
    face = paint.find(f"{space}appearance/{space}face")
    assert design["paint"]["appearance"]["face"] == [float(face.get(one)) for one in "Lab"]
PY
}

@test "a board as a session of the studio holds its pictures as they are" {
  write_board
  paint-pick -q --board board.txt -o board.session.json
  paint-pick -q --board board.txt -o picked.xml
  python3 - board.session.json picked.xml board.txt <<'PY'
import base64, json, sys
import xml.etree.ElementTree as tree
session = json.load(open(sys.argv[1]))
space = "{urn:goniochrome:paint:1}"
names = [paint.get("name") for paint in tree.parse(sys.argv[2]).getroot().iter(space + "paint")]
states = session["history"]["states"] + session["palette"]
assert [state["own"]["paint"]["name"] for state in states] == names and len(names) > 1
lines = [line.split() for line in open(sys.argv[3])]
files = {words[1]: words[2] for words in lines if words and words[0] == "image"}
[board] = session["pictures"]["boards"]
assert [picture["name"] for picture in board["pictures"]] == list(files)
for picture in board["pictures"]:
    head, data = picture["data"].split(",", 1)
    content = base64.b64decode(data)
    if head in ("data:image/png;base64", "data:image/jpeg;base64") and open(files[picture["name"]], "rb").read(1) in (b"\x89", b"\xff"):
        assert content == open(files[picture["name"]], "rb").read()
    else:
        assert content.startswith(b"\x89PNG")
for dropper in session["pictures"]["droppers"]:
    assert dropper["place"][1] < len(files) and dropper["kind"] in ("face", "flop", "gloss")
assert len(session["pictures"]["droppers"]) > 0
PY
  run --separate-stderr paint-pick --face "$TESTDATA/contact-sheet.jpg@10,10" -o x.session.json
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"a session shows a --board"* ]]
}

@test "a board as a page needs nothing beside itself" {
  write_board
  paint-pick -q --board board.txt -o board.html
  [ "$(grep -o 'data:image/png;base64' board.html | wc -l)" -eq 5 ]
  grep -q '<title>Beach &amp; Sea</title>' board.html
  grep -q 'Deep Sea gloss</span>' board.html
  grep -q 'drawn on a ball under two lamps' board.html
  ! grep -qE '(src|href)="[^d]' board.html || false
  xmllint --html --noout board.html 2>&1 | grep -vE 'Tag (header|section|figure|figcaption|main|article|svg|circle) invalid|^<|^ |\^' | grep -q error && return 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 128x64 -o small.exr
  prefilter-envmap -q small.exr --basis "$TESTDATA/b5.basis.xml" -o small.env.exr
  paint-pick -q --board board.txt -o board.html --mesh "$TESTDATA/speed-shape.obj" --env small.env.exr
  grep -q 'drawn on speed-shape.obj under small.env.exr' board.html
  paint-pick -q --board board.txt -o board.html --basis "$TESTDATA/b5.basis.xml"
  [ -s board.html ]
}

board_error() { # TEXT LINE...
  local text=$1
  shift
  printf '%s\n' "image sea sea.png" "paint A" "$@" >bad.txt
  run paint-pick --board bad.txt -o none.xml
  [ "$status" -eq 3 ] || { echo "$* gave $status: $output"; return 1; }
  [[ $output == *"$text"* ]] || { echo "$* said: $output"; return 1; }
  [ ! -e none.xml ]
}

@test "a board's mistakes are told with their line" {
  board_error 'bad.txt:3: "color" is none of title, image, paint, face' 'color red'
  board_error 'bad.txt:3: "face" lacks what it says' 'face'
  board_error 'bad.txt:3: "retro" stands alone' 'retro yes'
  board_error 'bad.txt:3: face is "sea": write IMAGE@X,Y' 'face sea'
  board_error 'bad.txt:3: face names the image "sky", which no line' 'face sky@1,1'
  board_error 'bad.txt:3: travel is "10": it lies above 15' 'travel 10'
  board_error 'bad.txt:4: the paint A has two droppers for its face' 'face sea@1,1' 'face sea@2,2'
  board_error 'bad.txt:3: there are two images named sea' 'image sea other.png'
  board_error 'bad.txt:3: image is "lone": write image NAME PATH' 'image lone'
  board_error 'bad.txt:3: there are two paints named A' 'paint A'
  board_error 'bad.txt: the paint A has neither face nor flop' 'travel 40'
  board_error 'sea.png' 'face sea@1,1'
  echo 'face sea@1,1' >bad.txt
  run paint-pick --board bad.txt
  [ "$status" -eq 3 ]
  [[ $output == *'bad.txt:1: "face" belongs below a line "paint NAME"'* ]]
  echo '# nothing' >bad.txt
  run paint-pick --board bad.txt
  [ "$status" -eq 3 ]
  [[ $output == *'bad.txt: has no paint'* ]]
}

@test "pictures of every format are read: gray, alpha, 8 bits, light, CMYK" {
  oiiotool two.png --ch R -o gray.png
  oiiotool two.png --ch R,G,B,A=1 -o alpha.png
  oiiotool two.png -d uint8 -o eight.tif
  oiiotool two.png --colorconvert sRGB linear -d half -o light.exr
  for image in gray.png alpha.png eight.tif; do
    paint-pick -q --face $image@20,30 --flop $image@80,30 -o out.xml --report r.json
    awk -v x="$(result 'paints[0].face[0]')" 'BEGIN { exit !(55 < x && x < 84) }' || { echo $image; return 1; }
  done
  paint-pick -q --face light.exr@20,30 -o out.xml
  oiiotool two.png --ch R,G,B,A=0 -o glass.png
  run paint-pick --face glass.png@20,30 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *"glass.png: every pixel about 20,30 is transparent"* ]]
  base64 -d >cmyk.jpg <<<'/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwAGBAUGBQQGBgUGBwcGCAoQCgoJCQoUDg8MEBcUGBgXFBYWGh0lHxobIxwWFiAsICMmJykqKRkfLTAtKDAlKCko/9sAQwEHBwcKCAoTCgoTKBoWGigoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgo/8AAFAgACAAIBAERAAIRAQMRAQQRAP/EABUAAQEAAAAAAAAAAAAAAAAAAAUI/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/EABUBAQEAAAAAAAAAAAAAAAAAAAYH/8QAFBEBAAAAAAAAAAAAAAAAAAAAAP/aAA4EAQACEQMRBAAAPwBAnQ1QL//Z'
  run paint-pick --face cmyk.jpg@4,4,2 -o out.xml
  [ "$status" -eq 0 ]
  [[ $output == *"cmyk.jpg is CMYK without a profile, converted without regard to its inks"* ]]
}

@test "the same scan reads the same color as PPM, PNG, TIFF and JPEG, of 8 and of 16 bits" {
  # Signals 149,90,121 are L* 45.742, a* 28.803, b* -7.171 in sRGB.
  awk 'BEGIN { print "P3\n40 30\n255"; for (i = 0; i < 1200; ++i) print "149 90 121" }' >scan.ppm
  awk 'BEGIN { print "P3\n40 30\n65535"; for (i = 0; i < 1200; ++i) print 149 * 257, 90 * 257, 121 * 257 }' >deep.ppm
  for end in png tif bmp tga dpx; do oiiotool scan.ppm -o scan.$end; done
  for end in png tif; do oiiotool deep.ppm -d uint16 -o deep.$end; done
  oiiotool scan.ppm --quality 100 -o scan.jpg
  # These files say Rec709, which OpenImageIO says of whole numbers with the curve of a display.
  oiiotool --info -v scan.png | grep -q 'oiio:ColorSpace: "Rec709"'
  for image in scan.ppm scan.png scan.tif scan.bmp scan.tga scan.dpx deep.ppm deep.png deep.tif scan.jpg; do
    paint-pick -q --face $image@20,15 -o out.xml --report r.json
    # JPEG rounds Y, Cb and Cr, which moves blue by up to 1.4 codes, 0.9 in b*.
    limit=0.002
    [ $image = scan.jpg ] && limit=0.9
    near "$(result 'paints[0].face[0]')" 45.742 $limit
    near "$(result 'paints[0].face[1]')" 28.803 $limit
    near "$(result 'paints[0].face[2]')" -7.171 $limit
  done
}

@test "densities of film in a DPX are no signals of a display" {
  awk 'BEGIN { print "P3\n4 4\n255"; for (i = 0; i < 16; ++i) print "149 90 121" }' >film.ppm
  oiiotool film.ppm -d uint10 -o film.dpx
  # The byte 801 of the header names the curve: 1 is printing density, 3 a logarithm, 6 that of ITU-R 709.
  for curve in 0 1 3 6 377; do # 0 is a curve of the user, and 377 none
    printf "\\x0$curve" | dd of=film.dpx bs=1 seek=801 conv=notrunc 2>dd.txt
    run paint-pick --face film.dpx@2,2,1 -o none.xml
    [ "$status" -eq $((curve == 6 ? 0 : 3)) ]
    case $curve in
    0) [[ $output == *'film.dpx: its color space is "User defined", which is not known'* ]] ;;
    1) [[ $output == *'film.dpx: its color space is "Printing density", which is not known'* ]] ;;
    esac
  done
  # The byte 802 names the primaries: 9 are those of NTSC.
  printf '\006\011' | dd of=film.dpx bs=1 seek=801 conv=notrunc 2>dd.txt
  run paint-pick --face film.dpx@2,2,1 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *'film.dpx: its color space is "NTSC composite video", which is not known'* ]]
}

@test "the fourth channel of a TGA or BMP is alpha where the file says so" {
  pixels() { # ALPHA, octal
    for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do printf "\\171\\132\\225\\$1"; done
  }
  tga() { # ALPHA-BITS ALPHA [TYPE]
    printf "\\0\\0\\2\\0\\0\\0\\0\\0\\0\\0\\0\\0\\4\\0\\4\\0\\40\\$((40 + $1))"
    pixels "$2"
    [ -z "${3-}" ] || { head -c 494 /dev/zero && printf "\\$3"; }
    [ -z "${3-}" ] && printf '\0\0\0\0' || printf '\122\0\0\0'
    printf '\0\0\0\0TRUEVISION-XFILE.\0'
  }
  tga 0 0 >bits.tga # black with the library's alpha
  tga 0 0 0 >none.tga
  tga 10 0 2 >kept.tga
  tga 10 377 3 >alpha.tga
  # A header of 40 bytes, and one of 108 with masks and sRGB.
  bmp() { # MASK-OF-RED MASK-OF-BLUE COLORS
    printf 'BM\272\0\0\0\0\0\0\0\172\0\0\0\154\0\0\0\4\0\0\0\4\0\0\0\1\0\40\0\3\0\0\0\100\0\0\0\0\0\0\0\0\0\0\0'
    printf "\\0\\0\\0\\0\\0\\0\\0\\0$1\\0\\377\\0\\0$2\\0\\0\\0\\0$3"
    printf '\1\1\1\1' && head -c 44 /dev/zero
    pixels 0
  }
  {
    printf 'BM\166\0\0\0\0\0\0\0\66\0\0\0\50\0\0\0\4\0\0\0\4\0\0\0\1\0\40\0\0\0\0\0\100\0\0\0\0\0\0\0\0\0\0\0'
    printf '\0\0\0\0\0\0\0\0'
    pixels 0
  } >plain.bmp
  red='\0\0\377\0' blue='\377\0\0\0' srgb='BGRs'
  bmp "$red" "$blue" "$srgb" >masks.bmp
  for image in bits.tga none.tga kept.tga alpha.tga plain.bmp masks.bmp; do
    paint-pick -q --face $image@2,2,1 -o out.xml --report r.json
    near "$(result 'paints[0].face[0]')" 45.742 0.002
    near "$(result 'paints[0].face[1]')" 28.803 0.002
  done
  bmp "$blue" "$red" "$srgb" >swapped.bmp
  bmp "$red" "$blue" '\0\0\0\0' >calibrated.bmp
  printf '\0\0\3\0\0\0\0\0\0\0\0\0\4\0\4\0\20\40' >gray.tga && pixels 0 >>gray.tga
  for case in 'swapped.bmp: is a BMP whose masks of red, green and blue are ff, ff00 and ff0000' \
    'calibrated.bmp: is a BMP that states primaries and curves of its own' 'gray.tga: is a gray TGA of 16 bits a pixel'; do
    run paint-pick --face "${case%%:*}@2,2,1" -o none.xml
    [ "$status" -eq 3 ]
    [[ $output == *"$case"* ]]
  done
}

@test "clipped spots are told" {
  oiiotool --create 20x20 3 --fill:color=1,1,1 20x20 -o white.png
  run paint-pick --face white.png@10,10 -o out.xml
  [ "$status" -eq 0 ]
  [[ $output == *"warning: face of picked: "*" pixels are as bright as the picture can show"* ]]
}

usage_error() { # TEXT ARGUMENTS...
  local text=$1
  shift
  run paint-pick -o none.xml "$@"
  [ "$status" -eq 2 ] || { echo "$* gave $status: $output"; return 1; }
  [[ $output == *"$text"* ]] || { echo "$* said: $output"; return 1; }
  [ ! -e none.xml ]
}

@test "usage errors name the option and the remedy" {
  usage_error "there is nothing to pick"
  usage_error '--face is "two.png": write IMAGE@X,Y or IMAGE@X,Y,RADIUS' --face two.png
  usage_error '--face is "two.png@1"' --face two.png@1
  usage_error '--flop is "two.png@1,x"' --flop two.png@1,x
  usage_error '--flop is "two.png@1,1,-2"' --flop two.png@1,1,-2
  usage_error '--gloss is "@1,1"' --face two.png@1,1 --gloss @1,1
  usage_error '--gloss alone makes no paint' --gloss two.png@1,1
  usage_error '--travel is "12"' --face two.png@1,1 --travel 12
  usage_error '--palette is "none"' --palette none two.png
  usage_error '--palette takes a picture: name one' --palette 4
  usage_error 'the picture two.png is given and no --palette' --face two.png@1,1 two.png
  usage_error 'exclude each other' --palette 4 --face two.png@1,1 two.png
  usage_error '--mesh, --env, --basis and --studio are for the page of a board' --face two.png@1,1 --mesh x.obj
  run paint-pick --face two.png@1,1 -o page.html
  [ "$status" -eq 2 ]
  [[ $output == *'--output is "page.html": a page shows a --board'* ]]
  run paint-pick --board b.txt --env e --basis b -o page.html
  [ "$status" -eq 2 ]
  [[ $output == *'--basis is for lamps'* ]]
}

@test "input errors name the file" {
  run paint-pick --face two.png@100,30 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *"two.png: the point 100,30 lies outside its 100 x 60 pixels"* ]]
  run paint-pick --face missing.png@1,1 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *missing.png* ]]
  run paint-pick --board missing.txt -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *missing.txt* ]]
  write_board
  for option in --mesh --env --basis; do
    run paint-pick -q --board board.txt -o none.html $option missing.file
    [ "$status" -eq 3 ]
    [[ $output == *missing.file* ]]
    [ ! -e none.html ]
  done
}

# A post on a floor hides a lamp from the floor behind it. All wear one matt paint, without gloss and without a coat.
shadow_stage() {
  cat >stage.obj <<'OBJ'
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -0.3 0 0
v 0.3 0 0
v 0.3 0.8 0
v -0.3 0.8 0
o floor
f 4 3 2 1
o post
f 5 6 7 8
OBJ
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml#primer_gray" -o gray.xml
  sed -E -e '/<(lobe|coat|gloss) /d' -e 's/<diffuse .*/<diffuse r="0.08" g="0.05" b="0.03"\/>/' gray.xml >matt.xml
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 32x16 -o studio.exr
  prefilter-envmap -q studio.exr --basis "$TESTDATA/b5.basis.xml" --tolerance 1e-2 -o studio.env.exr
  render-osmesa -q --mesh stage.obj --size 32x24 --samples 1 --camera 0,4,1.2,0,0,-0.3,35 -p matt.xml#primer_gray \
    --light 0,35,3,3,3@0 --env studio.env.exr --engine path --floor none --tolerance 1 --aov transport -o view.exr
  render-osmesa -q --gbuffer view.exr -p matt.xml#primer_gray -o view.png
}

@test "a dropper in a shadow finds the paint in the light that was traced there, and without it the error is told" {
  shadow_stage
  # K_D times pi is the reflectance: linear Rec.2020 .251 .157 .094, of Y .178 and L* 49.2. Picture and transport have a
  # noise of 1 dE00 each; over the 13 pixels of the disc it is 1.4 / sqrt(13) = .4, and twice that is the tolerance.
  for picture in view.exr view.png; do
    for place in 16,11 16,20 5,12; do
      paint-pick -q --face $picture@$place,2 --buffers view.exr -o out.xml --report r.json
      near "$(result 'paints[0].face[0]')" 49.2 0.8
      near "$(result 'paints[0].face[1]')" 15.6 0.8
      near "$(result 'paints[0].face[2]')" 21.0 0.8
      [ "$(result 'samples[0].lit')" = true ]
    done
  done
  # The control: the same paint is another one in the shadow.
  paint-pick -q --face view.png@16,11,2 -o out.xml --report dark.json
  paint-pick -q --face view.png@5,12,2 -o out.xml --report light.json
  awk -v d="$(jq '.results.paints[0].face[0]' dark.json)" -v l="$(jq '.results.paints[0].face[0]' light.json)" \
    'BEGIN { exit !(l - d > 8) }'
  run paint-pick --face view.exr@16,11,2 -o out.xml
  [ "$status" -eq 0 ]
  [[ $output == *"view.exr shows shadow"*"which a dropper takes for the color of the paint: give --buffers"* ]]
}

@test "buffers that do not fit are refused" {
  shadow_stage
  run paint-pick --face two.png@16,11 --buffers view.exr -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *"two.png: has 100 x 60 pixels, and the light was traced for 32 x 24"* ]]
  run paint-pick --palette 2 two.png --buffers view.exr -o none.xml
  [ "$status" -eq 2 ]
  [[ $output == *"--buffers is for droppers"* ]]
  render-osmesa -q --gbuffer view.exr -p matt.xml#primer_gray --aov normal,part -o plain.exr
  run paint-pick --face view.png@16,11 --buffers plain.exr -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *"plain.exr: holds no light that was traced: make it by render-osmesa --aov transport"* ]]
  [ ! -e none.xml ]
}

@test "what the mesh of a page says that is not understood is told" {
  write_board
  sed 's/"mesh": *0/"mesh": 0, "extensions": {"ACME_bend": {}}/' "$BATS_TEST_DIRNAME/../../lib/fuzz/corpus/gltf/triangle.gltf" >bent.gltf
  run --separate-stderr paint-pick --board board.txt --mesh bent.gltf -o board.html
  [ "$status" -eq 0 ]
  [[ $stderr == *"node 0 has the extension ACME_bend, which is not known here: what it changes is not drawn"* ]]
}

# Control: the picture without the entry that names its view.
@test "a picture in another view gives the paint that the same picture in the view Paint gives" {
  scene="--mesh $TESTDATA/box.obj --light 35,45 --size 64x48 --samples 1 --paint $TESTDATA/paints.paints.xml#arctic_white"
  render-osmesa -q $scene -o paint.png
  render-osmesa -q $scene --view 'ACES SDR' -o aces.png
  sed 's/goniochrome:view/goniochrome:vieX/' aces.png >nameless.png
  for picture in paint aces nameless; do
    paint-pick -q --face "$picture.png@20,40,3" -o x.xml --report $picture.json
  done
  distance() { jq -s '[.[].results.samples[0].lab] | [.[0][0] - .[1][0], .[0][1] - .[1][1], .[0][2] - .[1][2]] | map(. * .) | add | sqrt' "$@"; }
  awk -v near="$(distance paint.json aces.json)" -v far="$(distance paint.json nameless.json)" 'BEGIN { exit !(near < 1 && far > 5) }'
}

@test "a picture in a view of \$OCIO is read back through it, and refused without it" {
  cat >config.ocio <<'OCIO'
ocio_profile_version: 2
roles: {aces_interchange: aces, default: aces}
displays:
  Booth:
    - !<View> {name: Plain, colorspace: plain}
    - !<View> {name: Dim, colorspace: dim}
colorspaces:
  - !<ColorSpace> {name: aces}
  - !<ColorSpace>
    name: plain
    from_scene_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: "UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD"}
        - !<BuiltinTransform> {style: "DISPLAY - CIE-XYZ-D65_to_sRGB"}
  - !<ColorSpace>
    name: dim
    from_scene_reference: !<GroupTransform>
      children:
        - !<CDLTransform> {slope: [0.5, 0.5, 0.5]}
        - !<ColorSpaceTransform> {src: aces, dst: plain}
OCIO
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml#silver_fine" -o fitted.xml
  for view in Plain Dim; do
    OCIO=config.ocio render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --paint fitted.xml --light 0,30 --exposure 0 --size 96x54 \
      --samples 1 --effects auto,-rays --view $view -o $view.png
    OCIO=config.ocio paint-pick -q --face $view.png@48,27,1 -o $view.xml --report $view.json
  done
  plain=$(jq '.results.paints[0].face[0]' Plain.json)
  near "$(jq '.results.paints[0].face[0]' Dim.json)" "$plain" 0.1
  # Without the name of its view, half of the light is that of a darker paint.
  sed 's/goniochrome:view/goniochrome:vieX/' Dim.png >nameless.png
  paint-pick -q --face nameless.png@48,27,1 -o nameless.xml --report nameless.json
  awk -v plain="$plain" -v dark="$(jq '.results.paints[0].face[0]' nameless.json)" 'BEGIN { exit !(dark < plain - 5) }'
  run paint-pick --face Dim.png@48,27,1 -o none.xml
  [ "$status" -eq 3 ]
  [[ $output == *'was drawn by the view "Booth / Dim": there is no view "Booth / Dim"'* ]]
}
