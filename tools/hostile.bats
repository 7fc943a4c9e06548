# Faults that no tool may have with files, names and surroundings that nobody would wish for: end by a signal or as a bug, run on, or take
# memory out of proportion.
bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
}

# True if a sanitizer watches the tools: it takes terabytes of addresses for itself, and a multiple of the memory.
sanitized() {
  ldd "$(command -v render-osmesa)" | grep -q libasan
}

# refused WORDS COMMAND...: exit 3 and one line of error, which has WORDS in it.
refused() {
  local words=$1
  shift
  run --separate-stderr timeout -k 1 20 "$@"
  [ "$status" -eq 3 ] || { echo "$*: exit $status: $stderr"; return 1; }
  [[ "$stderr" = *"$words"* ]] || { echo "$*: $stderr"; return 1; }
}

@test "a PLY file that CGAL crashes on is an error" {
  printf 'ply\nformat ascii 1.0\nproperty float x\nelement vertex 3\nend_header\n0 0 0\n' >a.ply
  # Where a sanitizer watches, it ends the reader with a status of its own.
  local how=crashed
  sanitized && how="ended with status"
  refused "a.ply: the library that reads it $how" render-osmesa --mesh a.ply --light 0,20 --size 16x16 -o x.png
  refused "a.ply: the library that reads it $how" goniogeom-index --seam a,b --mesh a.ply "$TESTDATA/paints.paints.xml"
}

@test "an IFF picture is refused by name in every tool, whatever it is called" {
  # Without this choice by content, 12 of 40 damaged files corrupted memory.
  { printf 'FOR4\0\0\0\x40CIMGTBHD\0\0\0\x20'; head -c 60000 /dev/urandom; } >x.png
  cp x.png x.iff
  for image in x.png x.iff; do
    refused "$image: is an IFF picture" prefilter-envmap -q -e 6 -s 8 $image -o o.exr
    refused "$image: is an IFF picture" relight -q --from D65 --to A $image -o o.exr
    refused "$image: is an IFF picture" paint-pick -q --face $image@1,1
    refused "an IFF picture" prefilter-envmap -q -e 6 -s 8 -o o.exr <$image
  done
  [ ! -e o.exr ]
}

# closing DESCRIPTORS COMMAND...: runs it with those descriptors closed.
closing() {
  local list=$1 d
  shift
  (
    for d in $list; do eval "exec $d>&-"; done
    exec "$@"
  )
}

@test "with closed descriptors no message lands in a file, and a lost output is an error" {
  paint-convert "$TESTDATA/paints.paints.xml" --to csv -o whole.csv
  for list in 0 1 2 "0 1" "0 2" "1 2" "0 1 2"; do
    rm -f x.csv
    # The summary, and the warnings, go to standard error, which is to be none of the tool's files.
    closing "$list" paint-convert "$TESTDATA/paints.paints.xml" --to csv -o x.csv --report r.json 2>messages || {
      echo "closed $list: exit $?"
      return 1
    }
    cmp x.csv whole.csv
    jq -e .results.written r.json
    case $list in
      *1*)
        run closing "$list" paint-convert "$TESTDATA/paints.paints.xml" --to csv
        [ "$status" -eq 3 ] || { echo "closed $list: standard output was lost, exit $status"; return 1; }
        run closing "$list" paint-convert --help
        [ "$status" -eq 3 ]
        ;;
    esac
    case $list in
      *0*)
        run closing "$list" paint-convert --to csv -o y.csv
        [ "$status" -eq 3 ] || { echo "closed $list: standard input was replaced, exit $status"; return 1; }
        [ ! -e y.csv ]
        ;;
    esac
  done
}

@test "what is no plain file is written to and not replaced" {
  mkfifo pipe
  cat pipe >from-pipe &
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o pipe
  wait $!
  [ -p pipe ]
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o whole.csv
  cmp from-pipe whole.csv
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o /dev/null
  [ -c /dev/null ]
  # A name of an open file is that file, which keeps what it has.
  { echo before; paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o /dev/stdout; echo after; } >appended
  [ "$(head -n 1 appended)" = before ]
  [ "$(tail -n 1 appended)" = after ]
  [ "$(wc -l <appended)" -eq $(($(wc -l <whole.csv) + 2)) ]
}

@test "replacing a file keeps its mode, and the link that leads to it" {
  mkdir there
  echo old >there/x.csv
  chmod 640 there/x.csv
  ln -s there/x.csv link.csv
  ln -s link.csv second.csv
  ln -s there/new.csv loose.csv
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o second.csv
  [ -L second.csv ]
  [ -L link.csv ]
  [ "$(wc -l <there/x.csv)" -gt 1 ]
  [ "$(stat -c %a there/x.csv)" = 640 ]
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o loose.csv
  [ -L loose.csv ]
  cmp there/new.csv there/x.csv
  if [ "$(id -u)" -eq 0 ]; then
    chown 1:1 there/x.csv
    paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o there/x.csv
    [ "$(stat -c %u:%g there/x.csv)" = 1:1 ]
  fi
  [ "$(find . -name '.*.tmp' | wc -l)" -eq 0 ]
}

@test "names that cannot be: an error of input, before the work" {
  long=$(printf 'n%.0s' $(seq 300)) fits=$(printf 'n%.0s' $(seq 251)).xml
  ln -s a b
  ln -s b a
  paints=$TESTDATA/paints.paints.xml
  for name in "$long" a/x.csv a "$long/x.csv" none/x.csv "$paints/x.csv"; do
    refused "cannot be" paint-convert -q "$paints" --to csv -o "$name"
    refused "cannot be" paint-convert -q "$paints" --to csv -o x.csv --report "$name"
    refused "cannot be" paint-convert -q "$name" --to csv -o x.csv
    refused "is no folder" plot-paint -q "$paints" --pages "$name"
    [ "$name" = none/x.csv ] || { # which these two make
      refused "cannot be" prefilter-envmap -q -e 6 -s 8 "$TESTDATA/studio.exr" -o x.exr --cache "$name/deep"
      refused "cannot be" fit-paint -q -b "$TESTDATA/b5.basis.xml" "$paints" -o x.xml --color-map "$name/deep"
    }
    refused "" render-osmesa -q --mesh "$name" --light 0,20 --size 16x16 -o x.png
    refused "" colorsnap -q -l "$name" "$paints"
  done
  # Before the work: the input is not even opened.
  refused "$long: cannot be written" paint-convert -q none.xml --to csv -o "$long"
  # The longest name that there can be.
  paint-convert -q "$paints" -o "$fits"
  [ -s "$fits" ]
}

@test "a sequence and the sets of --each are found unwritable before the work" {
  mkdir out
  # The third picture of four, and the second set of two, have a folder in their place.
  mkdir out/turn-0003.exr out/set-2.basis.xml
  # Before the work: the input is not even opened.
  refused "turn-0003.exr: is a folder" render-osmesa -q --mesh none.obj --light 0,20 --size 8x8 --turntable 4 -o out/turn.exr
  refused "turn-0003.exr: is a folder" render-osmesa -q --mesh none.obj --light 0,20 --size 8x8 --light-sweep 4 -o out/turn.exr
  refused "set-2.basis.xml: is a folder" fit-basis -q none.xml --lobes 1..2 --each out/set- -o b.xml
  refused "none/set-1.basis.xml: cannot be written" fit-basis -q none.xml --lobes 1..2 --each none/set- -o b.xml
  [ "$(ls out | wc -l)" -eq 2 ]
  [ ! -e b.xml ]
}

@test "a forbidden folder is an error of input" {
  [ "$(id -u)" -eq 0 ] || skip "only root can become somebody else"
  mkdir forbidden
  cp "$TESTDATA/paints.paints.xml" forbidden/p.xml
  chmod 700 forbidden
  mkdir mine
  chmod 755 "$BATS_TEST_TMPDIR"
  chown 65534 mine
  cp "$TESTDATA/paints.paints.xml" mine/p.xml
  cp "$TESTDATA/studio.exr" mine/studio.exr  # the checkout may be closed to others
  chmod 644 mine/*
  local as_nobody="setpriv --reuid 65534 --clear-groups"
  $as_nobody test -r mine/p.xml || skip "the scratch folder is closed to others"
  refused "forbidden" $as_nobody paint-convert -q forbidden/p.xml --to csv
  for option in -o --report; do
    refused "forbidden" $as_nobody paint-convert -q mine/p.xml --to csv $option forbidden/x.csv
  done
  refused "forbidden" $as_nobody plot-paint -q mine/p.xml --pages forbidden/deep
  refused "forbidden" $as_nobody prefilter-envmap -q -e 6 -s 8 mine/studio.exr -o mine/x.exr --cache forbidden/deep
  # A file that is protected against writing stays.
  cp mine/p.xml mine/kept.csv
  chmod 444 mine/kept.csv
  refused "kept.csv: cannot be written" $as_nobody paint-convert -q mine/p.xml --to csv -o mine/kept.csv
  cmp mine/p.xml mine/kept.csv
}

usage() {
  local words=$1
  shift
  run --separate-stderr timeout -k 1 20 "$@" </dev/null
  [ "$status" -eq 2 ] || { echo "$*: exit $status: $stderr"; return 1; }
  [[ "$stderr" = *"$words"* ]] || { echo "$*: $stderr"; return 1; }
}

@test "a name is a name, whatever signs are in it" {
  cp "$TESTDATA/paints.paints.xml" x
  for name in '[x]' '[a,b]' '[]' '{x}' '%%' 'a b' '*' "it's" '$(x)' '-' '--'; do
    [ "$name" = - ] && continue
    rm -f ./"$name"
    refused "$name: cannot be read" paint-stats -- "$name"
    cp x ./"$name"
    paint-stats -q -- "$name" >by-name
    paint-stats -q x | cmp - by-name
    paint-stats -q -o "$name" x || [ "$name" = -- ]
    [ "$name" = -- ] || cmp by-name ./"$name"
  done
}

@test "an empty argument is a mistake and not standard input" {
  usage "is empty" paint-stats ""
  usage "is empty" paint-stats x "" y
  usage "is empty" paint-stats -- ""
  usage "--output is empty" paint-stats -o "" x
  usage "--output is empty" paint-stats --output= x
  usage "--report is empty" paint-stats --report "" x
  usage "--env is empty" render-osmesa --env ""
}

@test "two outputs of one name, or an output that is an input, are refused" {
  cp "$TESTDATA/paints.paints.xml" x
  ln -s x y
  usage "--output and --report" paint-stats x -o out --report out
  usage "--output and --report" paint-stats x -o out --report ./out
  usage "also read" paint-edit x --hue-shift 9 -o x
  usage "also read" paint-edit x --hue-shift 9 -o y
  usage "also read" paint-edit x --hue-shift 9 -o out --report x
  cmp x "$TESTDATA/paints.paints.xml"
  paint-stats -q x -o /dev/null --report /dev/null
}

@test "pages of paints whose names differ in a slash are two pages" {
  sed -n '1,/<\/paint>/p' "$TESTDATA/paints.paints.xml" >two.xml
  sed -n '/<paint /,/<\/paint>/p' two.xml >body
  { sed '/<paint /,$d' two.xml
    for name in a/b a_b a:b; do sed "s|<paint name=\"[^\"]*\"|<paint name=\"$name\"|" body; done
    echo '</paints>'; } >three.xml
  mkdir pages
  plot-paint -q three.xml --pages pages
  ls pages
  [ "$(ls pages | wc -l)" -eq 3 ]
}

@test "a paint whose values are no color is refused by line" {
  for value in 1e50 -10001 1e300 nan; do
    printf 'sample,geometry,illuminant,observer,L,a,b\nx,45as15,D65,10,50,1,2\nx,45as45,D65,10,40,%s,2\nx,45as110,D65,10,30,1,2\n' "$value" >v.csv
    refused "v.csv:3" paint-convert -q v.csv --to xml
    printf 'CGATS.17\nBEGIN_DATA_FORMAT\nSAMPLE_NAME LAB_L LAB_A LAB_B\nEND_DATA_FORMAT\nBEGIN_DATA\nx %s 1 2\nEND_DATA\n' "$value" >v.txt
    refused "v.txt:6" paint-convert -q v.txt --to xml
    sed "0,/<lab geometry=\"45as15\" L=\"[^\"]*\"/s//<lab geometry=\"45as15\" L=\"$value\"/" "$TESTDATA/paints.paints.xml" >v.xml
    for tool in "paint-stats" "fit-basis --lobes 1" "fit-paint -b $TESTDATA/b5.basis.xml" "goniogeom-index --lights 30 --views as15"; do
      # shellcheck disable=SC2086
      refused "v.xml:" $tool -q v.xml
    done
  done
  # The ends of the domain are colors still.
  printf 'sample,geometry,illuminant,observer,L,a,b\nx,45as15,D65,10,10000,-10000,10000\n' >v.csv
  paint-convert -q v.csv --to csv
  # A number that nothing in a paint can be.
  sed '0,/<gloss angle="60">[^<]*</s//<gloss angle="60">1e300</' "$TESTDATA/paints.paints.xml" >v.xml
  refused "1e300" paint-stats -q v.xml
}

@test "plots of all numbers end soon and hold numbers alone" {
  for rows in '0,1\na,1,1.0000000000000002' '0,1e-300\na,1,1e300' '0,-1e300\na,1,1e300' '0,5e-324\na,1,1e-323' \
    '9e299,9007199254740992\na,9.000000000000002e299,9007199254740994'; do
    for axes in none x y both; do
      printf "series,x,y\na,$rows\n" >t.csv
      timeout 10 draw-plot -q t.csv --logarithmic $axes -o t.svg
      ! grep -qE '["  ](-?nan|-?inf)' t.svg || false
      xmllint --noout t.svg
      [ "$(wc -c <t.svg)" -lt 100000 ]
    done
  done
  printf 'series,x,y\na,1,1e301\n' >far.csv
  refused "far.csv:2" draw-plot -q far.csv
}

@test "names that a spreadsheet would work out, and names in bad letters, come back or are legible" {
  { echo 'sample,geometry,illuminant,observer,L,a,b'
    for name in '=1+1' '+x' '-x' '@x' "'=x" "''=x" "'x" '=HYPERLINK(""a"",""b"")' '-5'; do printf '"%s",45as15,D65,10,50,1,2\n' "$name"; done; } >n.csv
  paint-convert -q n.csv -o n.xml
  paint-convert -q n.xml --to csv -o back.csv
  paint-convert -q back.csv -o again.xml
  cmp <(grep '<paint ' n.xml) <(grep '<paint ' again.xml)
  ! grep -qE '^"?[=+@-]' back.csv || false
  # CGATS holds no tabs: names that differ in one stay two names.
  printf 'sample,geometry,illuminant,observer,L,a,b\n"a\tb",45as15,D65,10,50,1,2\na b,45as15,D65,10,60,1,2\n' >tab.csv
  paint-convert -q tab.csv --to cgats -o tab.txt
  [ "$(paint-convert -q tab.txt --to csv | wc -l)" -eq 3 ]
  # Bytes outside UTF-8 on the command line.
  bad=$(printf 'caf\351')
  paint-convert -q tab.csv --to cxf -o "$bad.cxf" --report "$bad.json"
  paint-convert -q "$bad.cxf" --to csv >/dev/null
  xmllint --noout "$bad.cxf"
  printf 'series,x,y\na,1,2\n' | draw-plot -q --title "$bad" -o t.svg
  xmllint --noout t.svg
  printf 'P6\n2 1\n255\nabcdef' >p.ppm
  printf 'title %s <b>\nimage one p.ppm\npaint dawn\nface one@0,0\n' "$bad" >bad.board
  paint-pick -q -b bad.board -o page.html
  iconv -f UTF-8 -t UTF-8 page.html >/dev/null
  grep -q '<title>caf.* &lt;b&gt;</title>' page.html
}

@test "images from pipes work in every tool that takes one" {
  pipe_into() { # pipe_into FILE COMMAND...: FIFO stands for the pipe
    local file=$1
    shift
    rm -f fifo && mkfifo fifo
    cat "$file" >fifo &
    "$@" || { echo "$*: exit $?"; kill $!; return 1; }
    wait $!
  }
  prefilter-envmap -q -e 6 -s 8 "$TESTDATA/studio.exr" -o sky.env.exr
  prefilter-envmap -q -e 64 -s 8 --layout mip "$TESTDATA/studio.exr" -o mip.env.exr
  oiiotool --pattern fill:topleft=1,0,0:bottomright=0,.2,1 32x24 3 -d uint8 -o p.png
  render-osmesa -q --engine cpu --mesh "$TESTDATA/box.obj" --light 0,20 --size 32x24 --aov normal,aspecular,lambert,mask,part -o s.exr
  for image in "$TESTDATA/outdoor.exr" p.png; do
    pipe_into "$image" prefilter-envmap -q -e 6 -s 8 fifo -o o.exr
    pipe_into "$image" relight -q --from D65 --to A fifo -o o.exr
    pipe_into "$image" paint-pick -q --face fifo@4,4 -o o.xml
    pipe_into "$image" paint-pick -q --palette 2 fifo -o o.xml
  done
  pipe_into s.exr sketch-fit -q -i fifo -b s.exr -o o.xml
  pipe_into s.exr sketch-fit -q -i s.exr -b fifo -o o.xml
  oiiotool --pattern constant:color=1,1,1 32x24 3 -d uint8 -o white.png
  pipe_into white.png sketch-fit -q -i s.exr -b s.exr --mask fifo -o o.xml
  pipe_into s.exr render-osmesa -q --engine cpu --gbuffer fifo --light 0,20 -o o.exr
  pipe_into sky.env.exr render-osmesa -q --engine cpu --mesh "$TESTDATA/box.obj" --env fifo --size 32x24 -o o.png
  pipe_into mip.env.exr render-osmesa -q --engine cpu --mesh "$TESTDATA/box.obj" --env fifo --size 32x24 -o o.png
}

@test "meshes from pipes work in every tool that takes one" {
  printf 'OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n' >m.off
  printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >m.ply
  printf 'solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid s\n' >m.stl
  cp "$TESTDATA/box.obj" m.obj
  printf 'image one p.png\npaint dawn\nface one@4,4\n' >spring.board
  oiiotool --pattern fill:topleft=1,0,0:bottomright=0,.2,1 32x24 3 -d uint8 -o p.png
  for mesh in m.obj m.off m.ply m.stl; do
    draw=(render-osmesa -q --engine cpu --light 0,20 --size 32x24)
    "${draw[@]}" --mesh $mesh -o whole.png
    "${draw[@]}" --mesh <(cat $mesh) -o piped.png
    "${draw[@]}" --mesh - -o stdin.png <$mesh
    rm -f fifo && mkfifo fifo
    cat $mesh >fifo &
    "${draw[@]}" --mesh fifo -o fifo.png
    wait $!
    for picture in piped stdin fifo; do oiiotool --diff whole.png $picture.png; done
    paint-pick -q --board spring.board --mesh <(cat $mesh) -o page.html
  done
  # Two squares in one plane, which meet at x = 1.
  printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\no A\nf 1 2 3 4\no B\nf 2 5 6 3\n' >panels.obj
  { sed -n '1,/<\/paint>/p' "$TESTDATA/paints.paints.xml" && echo '</paints>'; } >one.xml
  for tool in goniogeom-index trompe-fit; do
    seam=(one.xml -q --seam A,B --unit m --light-from 0,75 --view-from 25,20)
    whole=0 piped=0
    $tool "${seam[@]}" --mesh panels.obj -o whole.out || whole=$?
    $tool "${seam[@]}" --mesh <(cat panels.obj) -o piped.out || piped=$?
    [ "$whole" -le 1 ]
    [ "$piped" -eq "$whole" ]
    cmp <(grep -v "$tool" whole.out) <(grep -v "$tool" piped.out)
  done
}

# within SECONDS MEGABYTES COMMAND...: exit 0 to 3 with no more processor time and memory than that.
within() {
  local seconds=$1 megabytes=$2 status=0
  shift 2
  if sanitized; then seconds=$((5 * seconds)) megabytes=$((5 * megabytes)); fi
  /usr/bin/time -o used -f '%U %S %M' timeout 100 "$@" >/dev/null 2>messages </dev/null || status=$?
  [ "$status" -le 3 ] || { echo "$*: exit $status: $(cat messages)"; return 1; }
  tail -n 1 used | awk -v s="$seconds" -v m="$megabytes" '{ exit !($1 + $2 <= s && $3 / 1024 <= m) }' || { echo "$*: $(cat used)"; return 1; }
}

@test "time and memory stay in proportion to the file" {
  # Each of these took from 7 s to more than a minute, or more than 1 GB.
  { printf 'CGATS.17\nBEGIN_DATA_FORMAT\nSAMPLE_NAME'
    awk 'BEGIN { for (i = 0; i < 7000; ++i) { g = sprintf("45as%d.%02d", i / 100, i % 100); printf " LAB_L_%s LAB_A_%s LAB_B_%s", g, g, g } }'
    printf '\nEND_DATA_FORMAT\nBEGIN_DATA\nEND_DATA\n'; } >fields.txt
  within 3 300 paint-convert fields.txt --to csv
  { printf '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="x"'; seq -f ' a%g="1"' 100000 | tr -d '\n'; printf '/></paints>'; } >attributes.xml
  within 3 200 paint-convert attributes.xml --to csv
  grep -q 'more than 256 attributes' messages
  { printf '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="x"><gloss angle="60">'; head -c 100000000 /dev/zero | tr '\0' 1; printf '</gloss></paint></paints>'; } >text.xml
  within 5 200 paint-convert text.xml --to csv
  { printf '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="x"><gloss angle="60">'; yes '11111<!-- -->' | head -c 30000000; printf '</gloss></paint></paints>'; } >pieces.xml
  within 20 200 paint-convert pieces.xml --to csv
  { printf '# made\n3\n400 550 700\n'; awk 'BEGIN { for (i = 0; i < 8000; ++i) printf "%g %g %g %g .3 .2 .1\n", .7, 0, i % 90 / 60, i / 900 }'; } >rows.brdf
  within 10 200 paint-convert rows.brdf --to csv
  # 900 fields that lie over each other, each as large as the file of 440 kB.
  /usr/bin/python3 - >over.bsdf <<'PY'
import struct, sys
fields = b"".join(struct.pack("<H", 4) + b"f%03d" % i + struct.pack("<HBQQ", 1, 10, 40000, 100000) for i in range(900))
head = b"tensor_file\0" + struct.pack("<BBI", 1, 0, 900) + fields
sys.stdout.buffer.write(head + bytes(440000 - len(head)))
PY
  within 3 200 paint-convert over.bsdf --to csv
  grep -q 'its fields overlap' messages
  printf 'OFF\n100000000 100000000 0\n0 0 0\n1 0 0\n0 1 0\n' >forged.off
  within 5 400 render-osmesa --engine cpu --mesh forged.off --light 0,20 --size 16x16 -o x.png
}

# every_tool: a line for each tool: the ending of its output, and the command without it.
every_tool() {
  { sed -n '1,/<\/paint>/p' "$TESTDATA/paints.paints.xml" && echo '</paints>'; } >one.xml
  printf 'P6\n16 8\n255\n' >p.ppm && head -c 384 "$TESTDATA/contact-sheet.jpg" >>p.ppm
  printf 'series,x,y\na,1,0.5\na,2,0.25\n' >table.csv
  printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >tri.off
  fit-paint -q -b "$TESTDATA/b5.basis.xml" one.xml -o fit.xml
  cat <<LIST
csv paint-convert -q $TESTDATA/paints.paints.xml --to csv
xml paint-edit -q one.xml --hue-shift 90
tsv paint-stats -q one.xml
xml fit-paint -q -b $TESTDATA/b5.basis.xml one.xml
xml fit-basis -q --lobes 1 --starts 1 one.xml
exr prefilter-envmap -q $TESTDATA/studio.exr -e 6,70 -s 8
exr prefilter-envmap -q p.ppm -e 6 -s 4
exr relight -q --from D65 --to A $TESTDATA/outdoor.exr
tsv goniogeom-index -q one.xml --lights 30 --views as15
xml trompe-fit -q one.xml --angle 2
tsv colorsnap -q -l $TESTDATA/paints.paints.xml -k 1 one.xml
tsv paint-compare -q -s one.xml one.xml
xml paint-pick -q --face p.ppm@4,4
svg plot-paint -q one.xml
gltf paint-export -q --to gltf fit.xml
exr paint-sbrdf -q fit.xml --size 8x8
svg draw-plot -q table.csv
png render-osmesa -q --engine cpu --mesh tri.off --light 0,20 --size 16x12 --samples 1
png render-osmesa -q --mesh tri.off --light 0,20 --size 160x120
LIST
}

has_tbb_2022() { ldconfig -p | awk '$1 == "libtbb.so.12" { print $NF; exit }' | xargs readlink -f | grep -qE '\.so\.12\.1[4-9]'; }

@test "with little memory every tool says what it lacked, and soon" {
  if sanitized; then skip "built with a sanitizer"; fi
  local tried=0 short=0
  while read -r ending line; do
    for kilobytes in 20000 50000 60000 75000 90000 110000 140000 180000 260000 400000 410000 500000 1000000; do
      status=0 tried=$((tried + 1))
      # shellcheck disable=SC2086
      /usr/bin/time -q -o used -f '%U %S' timeout -s KILL 60 bash -c 'ulimit -v "$1"; shift; exec "$@"' limited "$kilobytes" $line -o o.$ending \
        >/dev/null 2>err </dev/null || status=$?
      echo "$kilobytes: $line: exit $status, $(cat used) s: $(cat err)"
      # The loader of programs says it in its own words.
      if [ "$status" -eq 127 ]; then grep -q "shared" err && continue; fi
      # Where some hundred kB are missing, TBB 2022 waits for its own lock for ever when the first parallel loop begins, and
      # ends by a signal in its own constructor, before a tool has begun. Both are faults of that library alone.
      if [ "$status" -eq 137 ] && [ ! -s err ] && has_tbb_2022; then continue; fi
      if [ "$status" -eq 139 ] && [ ! -s err ] && has_tbb_2022; then
        begun=0
        (ulimit -v "$kilobytes" && exec "${line%% *}" --version) >/dev/null 2>&1 || begun=$?
        [ "$begun" -eq 139 ] && continue
      fi
      [ "$status" -le 1 ] && continue
      short=$((short + 1))
      [ "$status" -eq 3 ]
      grep -qi memory err
      # A second of processor time, with what was done before the memory ran out. The time on the clock is not the tool's alone
      # where others use the machine; the net of 60 s above is for a tool that waits for ever.
      awk '{ exit !($1 + $2 <= 1) }' used
    done
  done < <(every_tool)
  [ "$tried" -eq $(($(every_tool | wc -l) * 13)) ]
  [ "$short" -ge 20 ]
}

# without_threads FROM COMMAND...: runs it where the system starts no thread from that one on.
without_threads() {
  local from=$1
  shift
  timeout -s KILL 60 strace -f -qq -o none -e "inject=clone3:error=EAGAIN:when=$from+" "$@" </dev/null
}

@test "where no thread can be started every tool says so, whichever library wants one" {
  command -v strace >/dev/null && strace -o none true || skip "strace may not trace here"
  # A sanitizer has a function of its own for the start of threads.
  if sanitized; then skip "built with a sanitizer"; fi
  local lacking=0
  while read -r ending line; do
    for from in 1 2 4 7; do
      status=0
      echo old >o.$ending
      # shellcheck disable=SC2086
      without_threads $from $line -o o.$ending >printed 2>err || status=$?
      echo "from $from: $line: exit $status: $(cat err)"
      [ "$status" -le 1 ] && continue
      lacking=$((lacking + 1))
      [ "$status" -eq 3 ]
      grep -q "no thread can be started" err
      [ "$(wc -l <err)" -eq 1 ]
      [ "$(head -c 3 o.$ending)" = old ]
    done
  done < <(every_tool
    echo "png render-osmesa -q --engine path --mesh tri.off --light 0,20 --size 16x12 --samples 1"
    echo "png render-osmesa -q --engine gl --mesh tri.off --light 0,20 --size 160x120"
    echo "png render-osmesa -q --engine gl --mesh tri.off --light 0,20 --size 16x12 --samples 1")
  # OpenEXR's, TBB's and Mesa's: without that many this test would have met no library.
  [ "$lacking" -ge 12 ]
}

@test "with --threads 1 what needs no library of many threads works where none can be started" {
  command -v strace >/dev/null && strace -o none true || skip "strace may not trace here"
  if sanitized; then skip "built with a sanitizer"; fi
  printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >tri.off
  without_threads 1 prefilter-envmap -q --threads 1 -e 6 -s 8 "$TESTDATA/studio.exr" -o sky.env.exr
  without_threads 1 relight -q --threads 1 --from D65 --to A "$TESTDATA/outdoor.exr" -o o.exr
  without_threads 1 render-osmesa -q --threads 1 --engine path --mesh tri.off --env sky.env.exr --size 16x12 --samples 1 -o o.png
}

@test "SIGTERM and SIGINT end every tool soon, while it reads, works, waits or lacks memory" {
  { sed -n '1,/<\/paint>/p' "$TESTDATA/paints.paints.xml" && echo '</paints>'; } >one.xml
  oiiotool --pattern constant:color=.5,.4,.3 6000x3000 3 -d uint16 --compression zip -o slow.tif
  mkfifo nobody
  # ends PROCESS: waits for 10 s at most.
  ends() {
    for _ in {1..500}; do
      kill -0 "$1" 2>/dev/null || break
      sleep 0.02
    done
    kill -KILL "$1" 2>/dev/null || true
    wait "$1"
  }
  # sent SECONDS COMMAND...: the command gets $signal after that time, and ends by it, or was done before. What it takes from the
  # signal to its end may be a second of processor time and, since others use the machine too, 10 s on the clock. The times on the
  # clock are noted, for their median.
  sent() {
    local after=$1 status=0 process before took used TIMEFORMAT='%R %U %S'
    shift
    # A shell lets what it starts in the background ignore SIGINT.
    env --default-signal=INT "$@" >/dev/null 2>err </dev/null &
    process=$!
    sleep "$after"
    # The processor time so far in hundredths of a second; a tool that was done before has none to tell.
    before=$(sed 's/.*) //' "/proc/$process/stat" 2>/dev/null | awk '{ print $12 + $13 }')
    kill -s "$signal" "$process" 2>/dev/null || true
    { time ends "$process" 2>/dev/null || status=$?; } 2>took
    read -r took used < <(awk '{ print $1, $2 + $3 }' took)
    echo "$took" >>times
    case $status in
      0 | 1 | 3 | 130 | 143) awk -v u="$used" -v b="${before:-0}" 'BEGIN { exit !(u - b / 100 <= 1) }' && return ;;
    esac
    echo "SIG$signal after $after s: $*: exit $status, $took s, $used s of processor time, ${before:-0} hundredths of them before: $(cat err)"
    return 1
  }
  local least=400000
  if sanitized; then least=unlimited; fi
  for signal in TERM INT; do
    for after in 0.02 0.1 0.3 0.7; do
      sent $after paint-pick -q --face slow.tif@4,4 -o o.xml # a child reads it
      sent $after bash -c "ulimit -v $least; exec \"\$@\"" limited prefilter-envmap -q slow.tif -e 6 -s 8 -o o.exr
      sent $after bash -c "ulimit -v $least; exec \"\$@\"" limited prefilter-envmap -q "$TESTDATA/studio.exr" -e 6,70 -s 64 --verify 5000 -o o.exr
      sent $after render-osmesa -q --engine gl --mesh "$TESTDATA/speed-shape.obj" --light 0,20 --size 1600x900 --samples 16 -o o.png
      sent $after render-osmesa -q --engine path --mesh "$TESTDATA/box.obj" --light 0,20 --size 640x480 --tolerance .01 -o o.png
      sent $after fit-basis -q --lobes 6..9 one.xml -o o.xml
      sent $after trompe-fit -q one.xml --angle 2 -o o.xml
    done
    for waiting in "paint-pick -q --face nobody@1,1" "paint-convert -q nobody" "render-osmesa -q --light 0,20 -o o.png --mesh nobody" \
      "prefilter-envmap -q -e 6 nobody -o o.exr"; do
      # shellcheck disable=SC2086
      sent 0.2 $waiting
      [ ! -e o.exr ] || rm o.exr
    done
  done
  median=$(sort -n times | sed -n "$((($(wc -l <times) + 1) / 2))p")
  echo "ended within $median s (median), $(sort -n times | tail -n 1) s at most"
  awk -v m="$median" 'BEGIN { exit !(m <= 1) }'
  # Nobody is left who reads for a tool that is gone.
  for _ in {1..50}; do
    pgrep -f "slow.tif@4,4 -o o.xml" >/dev/null || return 0
    sleep 0.1
  done
  return 1
}

@test "SIGTERM and SIGINT end a tool wherever it is" {
  command -v strace >/dev/null && strace -o none true || skip "strace may not trace here"
  for signal in TERM INT; do
    for at in 5 40 90 130 170 220; do
      status=0
      timeout -s KILL 60 strace -f -qq -o none -e "inject=all:signal=$signal:when=$at" \
        prefilter-envmap -q -e 6 -s 8 "$TESTDATA/studio.exr" -o o.exr || status=$?
      # 0 where it ended before that call.
      [ "$status" -eq 143 ] || [ "$status" -eq 130 ] || [ "$status" -eq 0 ] || { echo "$signal at $at: $status"; return 1; }
    done
  done
}

@test "no amount of memory lets a tool abort before it begins" {
  if sanitized; then skip "a sanitizer takes terabytes of addresses for itself"; fi
  # The band in which its first constructors find none is some 70 kB wide.
  for kilobytes in $(seq 38000 40 62000); do
    status=0
    (ulimit -v "$kilobytes" && exec paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o start.csv) 2>err.txt || status=$?
    case $status in
      0 | 3) ;;
      127) [[ $(<err.txt) != *terminate* ]] ;;  # the system cannot even load it
      *) echo "$kilobytes: $status: $(<err.txt)"; false ;;
    esac
  done
}
