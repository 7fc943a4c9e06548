# render-osmesa with many paints: files, contact sheets and frames from one process.

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 32x16 -o studio.exr
  prefilter-envmap -q studio.exr --basis "$TESTDATA/b5.basis.xml" --tolerance 1e-2 -o studio.env.exr
  fit-paint -q --basis "$TESTDATA/b5.basis.xml" "$TESTDATA/paints.paints.xml" -o fitted.xml
  # Two walls that meet.
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
    --env studio.env.exr --aov transport --tolerance 3 -o transport.exr
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  library=$TESTDATA/paints.paints.xml
  fitted=$BATS_FILE_TMPDIR/fitted.xml
  walls="--mesh $BATS_FILE_TMPDIR/walls.obj --env $BATS_FILE_TMPDIR/studio.env.exr --size 48x36 --camera 0.6,0.8,4,0,-0.3,0,30"
  kept="--gbuffer $BATS_FILE_TMPDIR/transport.exr"
}

# apart A B: the largest difference of two pictures, 0..1.
apart() { oiiotool "$1" --ch R,G,B "$2" --ch R,G,B --absdiff --printstats | awk '/Stats Max/ { m = 0; for (i = 3; i <= 5; ++i) if ($i > m) m = $i; print m }'; }

# size FILE: WIDTHxHEIGHT
size() { oiiotool --info "$1" | sed -E 's/.*: +([0-9]+) x +([0-9]+),.*/\1x\2/'; }

@test "each paint of a library gets the picture that a run of its own makes" {
  render-osmesa -q $walls --paint "$fitted" --samples 4 -o '{name}.png' --report r.json
  count=$(grep -c '<paint ' "$fitted")
  [ "$(ls ./*.png | wc -l)" -eq "$count" ]
  [ "$(jq .results.frames r.json)" -eq "$count" ]
  [ "$(jq -r '.results.pictures[0].status' r.json)" = done ]
  for paint in silver_fine candy_red signal_white; do
    render-osmesa -q $walls --paint "$fitted#$paint" --samples 4 --effects all,-rays -o alone.png
    # The stream finds what is visible by rays, and looks the light of each lobe up once for all paints: that changes
    # single pixels at edges, and the others by no more than 2 of 255 steps.
    [ "$(oiiotool --fail 0.0099 --failpercent 1.5 --warn 0.0099 --warnpercent 1.5 $paint.png alone.png --diff | tail -1)" = PASS ]
  done
  render-osmesa -q $walls --paint "$fitted#candy_red" --samples 4 --effects all,-rays -o other.png
  [ "$(oiiotool --fail 0.0099 --failpercent 1.5 --warn 0.0099 --warnpercent 1.5 signal_white.png other.png --diff | tail -1)" = FAILURE ]
}

@test "pictures are the same on any number of threads" {
  for threads in 1 3; do
    mkdir $threads
    render-osmesa -q $walls --paint "$fitted" -o "$threads/{index}.exr" --threads $threads
  done
  pairs=()
  for picture in 1/*.exr; do pairs+=("$picture" "3/${picture#1/}" --diff); done
  [ "$(oiiotool "${pairs[@]}" | grep -c '^PASS')" -eq "$(grep -c '<paint ' "$fitted")" ]
}

@test "paints without lobes are fitted to --basis, as fit-paint would" {
  render-osmesa -q $walls --paint "$library#candy*" --basis "$TESTDATA/b5.basis.xml" -o '{name}-here.exr'
  render-osmesa -q $walls --paint "$fitted#candy*" -o '{name}-before.exr'
  [ "$(oiiotool candy_red-here.exr candy_red-before.exr --diff | tail -1)" = PASS ]
  # A single picture takes --basis as well.
  render-osmesa -q $walls --paint "$library#candy_red" --basis "$TESTDATA/b5.basis.xml" --effects all,-rays -o one.exr
  render-osmesa -q $walls --paint "$fitted#candy_red" --effects all,-rays -o two.exr
  [ "$(oiiotool one.exr two.exr --diff | tail -1)" = PASS ]
  run render-osmesa $walls --paint "$library#candy_red" -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "the environment has no lobe of exponent 1.3" ]]
}

@test "paints that fail are told by name, and the others are drawn" {
  {
    echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'
    echo '<paint name="good"><appearance travel="60"><face L="50" a="10" b="5"/><flop L="20" a="3" b="1"/></appearance></paint>'
    echo '<paint name="empty"/>'
    echo '<paint name="wrong"><appearance travel="60"><face L="5,0" a="10" b="5"/><flop L="20" a="3" b="1"/></appearance></paint>'
    echo '<paint name="last" code="L 9"><appearance travel="60"><face L="50" a="-10" b="5"/><flop L="20" a="3" b="1"/></appearance></paint>'
    echo '</paints>'
  } >mixed.xml
  run render-osmesa $walls --basis "$TESTDATA/b5.basis.xml" --paint - -o '{code}.png' --report r.json <mixed.xml
  [ "$status" -eq 1 ]
  [[ "$output" =~ 'no picture: standard input: paint "empty" has no color' ]]
  [[ "$output" =~ 'L is "5,0"' || "$output" =~ '5,0' ]]
  [[ "$output" =~ "2 paints failed" ]]
  [ -e good.png ]
  [ -e 'L 9.png' ]
  [ "$(ls ./*.png | wc -l)" -eq 2 ]
  [ "$(jq .results.failed r.json)" -eq 2 ]
  [ "$(jq -r '.results.pictures[1].status' r.json)" = failed ]
  # A name is told once, also where the light was traced for other paints.
  fit-paint -q --basis "$TESTDATA/b7.basis.xml" "$library#candy_red" -o other.xml
  run render-osmesa $kept --paint other.xml -o '{name}.png'
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'the paint "candy_red": a paint has a lobe of exponent' ]]
  # Where nothing can be drawn, that is the error.
  run render-osmesa $walls --basis "$TESTDATA/b5.basis.xml" --paint 'mixed.xml#empty' -o '{code}.png'
  [ "$status" -eq 3 ]
  run render-osmesa $walls --paint absent.xml -o '{name}.png'
  [ "$status" -eq 3 ]
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"></paints>' >none.xml
  run render-osmesa $walls --paint none.xml -o '{name}.png'
  [ "$status" -eq 3 ]
  [[ "$output" =~ "none.xml: there is no paint in it" ]]
}

@test "names become safe, and those that collide are told apart" {
  {
    echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'
    for name in '../x' 'a/b' 'a:b' 'a_b'; do
      echo "<paint name=\"$name\"><appearance travel=\"60\"><face L=\"50\" a=\"10\" b=\"5\"/><flop L=\"20\" a=\"3\" b=\"1\"/></appearance></paint>"
    done
    echo '</paints>'
  } >names.xml
  render-osmesa -q $walls --basis "$TESTDATA/b5.basis.xml" --paint names.xml -o '{name}.png'
  [ "$(ls ./*.png | tr '\n' ' ')" = './_._x.png ./a_b-2.png ./a_b-3.png ./a_b.png ' ]
  [ ! -e ../x.png ]
}

@test "variations stand around their paint on a labeled sheet" {
  paint-edit "$library#candy_red" --variations face |
    render-osmesa -q $kept --basis "$TESTDATA/b5.basis.xml" --paint - --tolerance 20 --sheet 3x3 -o v.png --report r.json
  # 3 pictures of 32 x 24 pixels with a strip of 11 below, and 4 gaps of 2.
  [ "$(size v.png)" = 104x113 ]
  [ "$(jq .results.files r.json)" -eq 1 ]
  [ "$(jq .results.frames r.json)" -eq 9 ]
  jq -e '[.results.pictures[].cell] == [5,1,2,3,4,6,7,8,9]' r.json
  render-osmesa -q $kept --basis "$TESTDATA/b5.basis.xml" --paint "$library#candy_red" --tolerance 20 -o one.png
  oiiotool v.png --cut 32x24+36+39 -o middle.png
  awk -v a="$(apart middle.png one.png)" 'BEGIN { exit !(a == 0) }'
  oiiotool v.png --cut 32x24+2+2 -o corner.png
  awk -v a="$(apart corner.png one.png)" 'BEGIN { exit !(a > 0.01) }'
}

@test "more paints than cells fill several sheets" {
  count=$(grep -c '<paint ' "$fitted")
  render-osmesa -q $kept --paint "$fitted" --tolerance 50 --sheet 2x2 -o 'sheet-{index}.png' --report r.json
  [ "$(ls sheet-*.png | wc -l)" -eq $(((count + 3) / 4)) ]
  [ "$(jq .results.files r.json)" -eq $(((count + 3) / 4)) ]
  run render-osmesa $kept --paint "$fitted" --tolerance 50 --sheet 2x2 -o sheet.png
  [ "$status" -eq 2 ]
  [[ "$output" =~ "write {index} into it" ]]
  [ ! -e sheet.png ]
}

@test "frames go to standard output" {
  render-osmesa -q $kept --paint "$fitted" --tolerance 50 --to ppm -o - >frames.ppm
  count=$(grep -c '<paint ' "$fitted")
  [ "$(stat -c %s frames.ppm)" -eq $((count * (13 + 3 * 32 * 24))) ]
  render-osmesa -q $kept --paint "$fitted" --tolerance 50 --to y4m -o - >frames.y4m
  [ "$(head -1 frames.y4m)" = 'YUV4MPEG2 W32 H24 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED' ]
  [ "$(stat -c %s frames.y4m)" -eq $((57 + count * (6 + 3 * 32 * 24))) ]
  render-osmesa -q $walls --paint "$fitted#candy_red" --effects auto,-rays --turntable 3 --to ppm -o - >turn.ppm
  [ "$(stat -c %s turn.ppm)" -eq $((3 * (13 + 3 * 48 * 36))) ]
  # The first frame is the picture of the first paint.
  head -c $((13 + 3 * 32 * 24)) frames.ppm >first.ppm
  first=$(sed -nE 's/.*<paint name="([^"]*)".*/\1/p' "$fitted" | head -1)
  render-osmesa -q $kept --paint "$fitted#$first" --tolerance 50 -o first.png
  [ "$(oiiotool first.ppm first.png --diff | tail -1)" = PASS ]
}

@test "frames of EXR are the scene-linear pictures, all of one size" {
  render-osmesa -q $kept --paint "$fitted" --tolerance 50 -o '{index}.exr'
  render-osmesa -q $kept --paint "$fitted" --tolerance 50 --to exr -o - >frames
  count=$(grep -c '<paint ' "$fitted")
  [ $(($(stat -c %s frames) % count)) -eq 0 ]
  split -a 3 -d -b $(($(stat -c %s frames) / count)) frames frame-
  pairs=()
  for ((i = 0; i < count; ++i)); do
    mv "$(printf 'frame-%03d' "$i")" "frame-$i.exr"
    pairs+=("frame-$i.exr" "$(printf '%04d.exr' $((i + 1)))" --diff)
  done
  [ "$(oiiotool --fail 0 --warn 0 "${pairs[@]}" | grep -c '^PASS')" -eq "$count" ]
  [ "$(oiiotool --fail 0 --warn 0 "frame-$((count - 1)).exr" 0001.exr --diff | tail -1)" = FAILURE ]
  render-osmesa -q $walls --paint "$fitted#candy_red" --effects auto,-rays --turntable 3 --to exr -o - >turn
  [ $(($(stat -c %s turn) % 3)) -eq 0 ]
}

@test "several paints and one name are an error that tells the ways out" {
  run render-osmesa $walls --paint "$fitted" -o x.png
  [ "$status" -eq 2 ]
  [[ "$output" =~ "-o '{name}.png', or --sheet 3x3" ]]
  run render-osmesa $walls --paint - -o x.png <"$fitted"
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--sheet 3x3" ]]
  for wrong in "--turntable 4" "--check 5" "--aov normal" "--split a.xml,b.xml"; do
    run render-osmesa $walls --paint "$fitted" $wrong -o '{name}.exr'
    [ "$status" -eq 2 ]
    [[ "$output" =~ "is for pictures of one paint" ]]
  done
  run render-osmesa $walls --paint "$fitted" --effects +rays -o '{name}.png'
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--gbuffer view.exr" ]]
  run render-osmesa $walls --paint "$fitted" -o '{face}-{name}.png'
  [ "$status" -eq 2 ]
  [[ "$output" =~ "{face} is not known here" ]]
  run render-osmesa $walls --paint "$fitted" --to y4m -o x.png
  [ "$status" -eq 2 ]
  run render-osmesa $walls --paint "$fitted" --sheet 3 -o x.png
  [ "$status" -eq 2 ]
  [[ "$output" =~ "write COLSxROWS" ]]
}

@test "memory does not grow with the number of paints" {
  # A sanitizer keeps what is freed for a while, 256 MB of it if it is not told otherwise.
  peak() { ASAN_OPTIONS=${ASAN_OPTIONS:-}:quarantine_size_mb=1 /usr/bin/time -f %M "$@" 2>&1 >/dev/null | tail -1; }
  for i in $(seq 40); do sed -nE "s/(<paint name=\")([^\"]*)/\1\2-$i/p;/<paint name/!p" "$fitted" | sed -n '/<paint name/,/<\/paint>/p'; done >many.body
  { echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'; cat many.body; echo '</paints>'; } >many.xml
  few=$(peak render-osmesa -q $kept --paint "$fitted" --tolerance 90 --to ppm -o -)
  many=$(peak render-osmesa -q $kept --paint many.xml --tolerance 90 --to ppm -o -)
  # Forty times as many paints: a tenth more is what allocators keep.
  [ "$many" -lt $((few * 11 / 10 + 8000)) ]
}
