# Faults that no tool may have when its world breaks: lose the old file, leave half of a new one, end on a signal, or say nothing.
#
# FAULT_KILLS is how often every tool is killed [1]; FAULT_SEED starts the random moments [1].
bats_require_minimum_version 1.5.0

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  paints=$TESTDATA/paints.paints.xml
  sed -n '1,/<\/paint>/p' "$paints" >one.xml
  echo '</paints>' >>one.xml
  # 60 paints, for what shall take a while.
  { sed -n '/<paints/p' "$paints"
    for i in $(seq 60); do sed -n '/<paint /,/<\/paint>/p' one.xml | sed "s/<paint name=\"[^\"]*\"/<paint name=\"p$i\"/"; done
    echo '</paints>'; } >many.xml
  fit-paint -q -b "$TESTDATA/b5.basis.xml" one.xml -o fitted.xml
  prefilter-envmap -q "$TESTDATA/studio.exr" -b "$TESTDATA/b5.basis.xml" -s 8 -o sky.env.exr
  name=$(grep -o 'paint name="[^"]*"' one.xml | cut -d'"' -f2)
  scene="--mesh $TESTDATA/speed-shape.obj --light 0,20 --size 96x54 --samples 1 --effects auto,-rays --paint fitted.xml#$name"
  render-osmesa -q $scene --aov normal,aspecular,lambert,mask,part -o seen.exr
  render-osmesa -q $scene -o seen.png
  printf 'series,x,y\na,1,0.5\na,2,0.25\n' >table.csv
  sed "s#^stripes#$TESTDATA/capture/&#; 12q" "$TESTDATA/capture/photos.csv" >photos.csv
  # Every tool that writes, with all but its output.
  cat >writers <<EOF
paint-convert -q many.xml --to csv
paint-edit -q many.xml --hue-shift 90
paint-stats -q many.xml
fit-paint -q -b $TESTDATA/b5.basis.xml many.xml
fit-basis -q --lobes 2 --starts 1 many.xml
prefilter-envmap -q $TESTDATA/studio.exr --exponents 6,70 -s 8
render-osmesa -q $scene --env sky.env.exr
goniogeom-index -q one.xml --lights 30,45 --views as15,as45
trompe-fit -q one.xml --angle 2
colorsnap -q -l many.xml -k 3 one.xml
relight -q --from D65 --to A $TESTDATA/outdoor.exr
sketch-fit -q -i seen.exr -b seen.exr
paint-pick -q --face seen.png@40,25 --flop seen.png@60,30
plot-paint -q --paint $name fitted.xml
draw-plot -q table.csv
paint-export -q --to gltf fitted.xml#$name
fit-sbrdf -q -n 1 --width 2 photos.csv
paint-sbrdf -q fitted.xml#$name --size 8x8
EOF
  # Without the compiler for WebAssembly, this one writes nothing.
  [ ! -f "$(dirname "$(command -v paint-studio)")/../lib/goniochrome/studio.wasm" ] ||
    echo "paint-studio -q --mesh $TESTDATA/box.obj --env sky.env.exr -b $TESTDATA/b5.basis.xml one.xml" >>writers
  # The ending of the output where it matters: pictures and drawings.
  cat >endings <<'EOF'
prefilter-envmap exr
render-osmesa exr
relight exr
paint-sbrdf exr
plot-paint svg
draw-plot svg
EOF
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  ln -s "$BATS_FILE_TMPDIR"/*.{xml,exr,png,csv} .
}

# each_writer FUNCTION: calls FUNCTION TARGET COMMAND... for every tool, TARGET being a name for its output. FUNCTION
# checks each of its steps itself: it is called in a condition, where the shell does not stop at a failure.
each_writer() {
  local line tool ending
  while read -r line; do
    tool=${line%% *}
    ending=$(sed -n "s/^$tool //p" "$BATS_FILE_TMPDIR/endings")
    # shellcheck disable=SC2086
    "$1" "$tool.out.${ending:-txt}" $line </dev/null || return 1
  done <"$BATS_FILE_TMPDIR/writers"
}

# hard WHAT TEXTBOOK OURS UNIT: a figure for scripts/hard-cases.
hard() { echo "# hard: $1 $2 $3 0 $4 $5" >&3; }

killed() {
  local target=$1 reference began took
  shift
  mkdir out
  began=$(date +%s%N)
  "$@" -o "out/$target" || { echo "$1 failed"; return 1; }
  took=$((($(date +%s%N) - began) / 1000))
  mv "out/$target" whole
  for ((i = 0; i < ${FAULT_KILLS:-1}; ++i)); do
    echo old >"out/$target"
    "$@" -o "out/$target" &
    sleep "$(awk -v r=$RANDOM -v t=$took 'BEGIN { printf "%.6f", r / 32768 * t * 1.2e-6 }')"
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
    kills=$((kills + 1))
    if ! cmp -s "out/$target" whole && [ "$(cat "out/$target")" != old ]; then
      echo "$1: half a file after $i kills"
      lost=$((lost + 1))
    fi
    [ "$(find out -type f ! -name '.*' | wc -l)" -eq 1 ] || { echo "$1 left:"; ls -A out; return 1; }
  done
  rm -r out whole
}

@test "HardCase interrupted: killed at any moment, a tool leaves the old file or the whole new one" {
  RANDOM=${FAULT_SEED:-1} kills=0 lost=0
  each_writer killed
  # The control writes in place.
  echo old >control
  { printf half; kill -9 $BASHPID; } >control & wait $! 2>/dev/null || true
  [ "$(cat control)" = half ]
  echo "$kills kills"
  hard interrupted 1 "$lost" files "files half-written by tools that were killed"
  [ "$lost" -eq 0 ]
}

full() {
  local target=$1
  shift
  echo old >"$target"
  ln -s /dev/full "full.$target" # its ending chooses the format
  run --separate-stderr "$@" -o "full.$target"
  [ "$status" -eq 3 ] || { echo "$1 on a full device: exit $status: $stderr"; return 1; }
  [[ "$stderr" = *"No space left"* ]] || { echo "$1: $stderr"; return 1; }
  # A limit that the output passes: nothing may be left of it.
  run bash -c 'ulimit -f 0; "$@" 2>&1 >/dev/null | cat; exit ${PIPESTATUS[0]}' limited "$@" -o "$target"
  [ "$status" -eq 3 ] || { echo "$1 beyond the limit of a file: exit $status: $output"; return 1; }
  [ "$(cat "$target")" = old ] || { echo "$1: the old file is lost"; return 1; }
}

@test "a full disk is an error, and the old file stays" {
  each_writer full
}

# In a mount namespace of its own: a disk of one page, which the old file fills.
small_disk() {
  local target=$1
  shift
  run unshare -rm bash -c 'mount -t tmpfs -o size=4k none disk && echo old >"disk/$1" && target=$1 && shift || exit 99
    "$@" -o "disk/$target"; status=$?
    [ "$(cat "disk/$target")" = old ] && [ "$(ls -A disk)" = "$target" ] || exit 98
    exit $status' disk "$target" "$@"
  [ "$status" -eq 3 ] || { echo "$1 on a small disk: exit $status: $output"; return 1; }
  [[ "$output" = *"No space left"* ]] || { echo "$1: $output"; return 1; }
}

@test "a disk without room is an error, the old file stays, and nothing else is left" {
  mkdir disk
  unshare -rm mount -t tmpfs none disk 2>/dev/null || skip "no disk may be mounted here"
  each_writer small_disk
}

@test "where /proc is not mounted, files are written, and nothing else is left" {
  unshare -rm mount -t tmpfs none /proc 2>/dev/null || skip "/proc may not be hidden here"
  mkdir bare
  for content in new again; do
    run unshare -rm bash -c 'mount -t tmpfs none /proc && exec "$@"' bash \
      paint-convert -q "$BATS_FILE_TMPDIR/many.xml" --to csv -o bare/paints.csv
    [ "$status" -eq 0 ] || { echo "$content: exit $status: $output"; return 1; }
    [ "$(ls -A bare)" = paints.csv ]
    paint-convert -q "$BATS_FILE_TMPDIR/many.xml" --to csv | cmp - bare/paints.csv
  done
}

readonly_target() {
  shift
  for place in /proc/none.exr no/such/folder/file.exr; do
    run --separate-stderr "$@" -o "$place"
    [ "$status" -eq 3 ] || { echo "$1 -o $place: exit $status: $stderr"; return 1; }
    [[ "$stderr" = *"$place"* ]] || { echo "$1: $stderr"; return 1; }
  done
}

@test "where messages cannot be written either, the exit status still tells" {
  for tool in $(cut -d' ' -f1 "$BATS_FILE_TMPDIR/writers"); do
    status=0
    "$tool" --no-such-option 2>/dev/full || status=$?
    [ "$status" -eq 2 ]
    status=0
    "$tool" --help >/dev/full 2>/dev/null || status=$?
    [ "$status" -eq 3 ]
  done
}

@test "a target that cannot be written is an error that names it" {
  each_writer readonly_target
}

closed() {
  shift
  case $1 in prefilter-envmap | fit-basis | goniogeom-index) return 0 ;; esac # one short write, before the pipe breaks
  # The reader is gone before the tool writes.
  ( "$@" -o - 2>err; echo $? >status ) | true
  [ ! -s err ] || { echo "$1: $(cat err)"; return 1; }
  case $(cat status) in 0 | 1 | 141) ;; *) echo "$1: exit $(cat status)"; return 1 ;; esac
}

@test "a closed pipe ends every tool quietly" {
  each_writer closed
}

@test "a pipeline whose end closes is quiet at each stage" {
  { paint-convert -q many.xml -o - 2>e1 | paint-edit -q --hue-shift 9 2>e2 |
    fit-paint -q -b "$TESTDATA/b5.basis.xml" 2>e3 | paint-stats -q 2>e4 | head -n 1 >/dev/null; } || true
  cat e1 e2 e3 e4
  [ ! -s e1 ]
  [ ! -s e2 ]
  [ ! -s e3 ]
  [ ! -s e4 ]
}

@test "300 MB of address space: paints stream, and what does not fit is told" {
  # A sanitizer takes terabytes of addresses for itself.
  if ldd "$(command -v paint-convert)" | grep -q libasan; then skip "built with a sanitizer"; fi
  { sed -n '/<paints/p' many.xml
    sed -n '/<paint /,/<\/paint>/p' many.xml >body
    for i in $(seq 100); do sed "s/name=\"p/name=\"q$i./" body; done
    echo '</paints>'; } >long.xml
  (ulimit -v 307200; paint-convert -q long.xml --to csv -o long.csv)
  [ "$(wc -l <long.csv)" -gt 6000 ]
  # 8192 x 4096 pixels: 400 MB as floats.
  oiiotool --create 8192x4096 3 --compression zip -o huge.exr
  run --separate-stderr bash -c 'ulimit -v 307200; prefilter-envmap huge.exr --exponents 6 -s 8 -o none.exr'
  echo "exit $status: $stderr"
  [ "$status" -eq 3 ]
  [[ "$stderr" = *huge.exr*memory* ]]
  [ ! -e none.exr ]
}

# The whole file, or none and the reason.
in_300_mb() {
  local target=$1 status=0
  shift
  (ulimit -v 307200; exec "$@" -o "$target") 2>err || status=$?
  case $status in
    0 | 1) [ -s "$target" ] || { echo "$1 wrote nothing"; return 1; } ;;
    3) grep -qE "memory|map segment" err && [ ! -e "$target" ] || { echo "$1: $(cat err)"; return 1; } ;;
    *) echo "$1 in 300 MB: exit $status: $(cat err)"; return 1 ;;
  esac
}

@test "300 MB of address space: every tool ends by itself, with a whole file or none" {
  if ldd "$(command -v paint-convert)" | grep -q libasan; then skip "built with a sanitizer"; fi
  each_writer in_300_mb
}

@test "whatever little memory there is, drawing ends by itself" {
  if ldd "$(command -v paint-convert)" | grep -q libasan; then skip "built with a sanitizer"; fi
  draw=$(grep '^render-osmesa' "$BATS_FILE_TMPDIR/writers")
  for kilobytes in $(seq 350000 50000 900000); do
    status=0
    # shellcheck disable=SC2086
    (ulimit -v "$kilobytes"; exec $draw -o drawn.exr) 2>err || status=$?
    echo "$kilobytes: exit $status: $(cat err)"
    [ "$status" -eq 0 ] || { [ "$status" -eq 3 ] && grep -qE "memory|map segment" err; }
  done
}

localized() {
  local target=$1
  shift
  LC_ALL=C "$@" -o "$target" || { echo "$1 failed"; return 1; }
  mv "$target" plain
  LC_ALL=de_DE.UTF-8 "$@" -o "$target" || { echo "$1 failed in German"; return 1; }
  cmp plain "$target" || { echo "$1 writes otherwise in German"; return 1; }
}

@test "HardCase xml-hostile: every tool writes the same bytes in a German locale" {
  export LOCPATH=$BATS_TEST_TMPDIR/locale
  mkdir "$LOCPATH"
  localedef -i de_DE -f UTF-8 "$LOCPATH/de_DE.UTF-8" 2>/dev/null || true
  # The control: this locale does write a comma.
  [ "$(LC_ALL=de_DE.UTF-8 bash -c 'printf %.1f 0,5')" = 0,5 ]
  each_writer localized
  hard xml-hostile 1 0 files "files of tools that differ in a German locale"
}

threaded() {
  local target=$1 count
  shift
  for count in 1 2 7; do
    "$@" --threads $count -o "$target"
    [ $? -le 1 ] || { echo "$1 failed with $count threads"; return 1; }
    # The command line is kept in some files; it alone may differ.
    sed "s/--threads $count/--threads N/g" "$target" >"by-$count"
  done
  cmp by-1 by-2 && cmp by-1 by-7 || { echo "$1 depends on the threads"; differing=$((differing + 1)); }
}

@test "HardCase threads: 1, 2 and 7 of them write the same bytes" {
  differing=0
  each_writer threaded
  hard threads 1 "$differing" files "files of tools that differ with 1, 2 and 7 threads"
  [ "$differing" -eq 0 ]
}

@test "an environment that was cut off is refused wherever the cut is" {
  size=$(stat -L -c %s sky.env.exr)
  for cut in 0 3 7 100 $((size / 3)) $((size / 2)) $((size - 1)); do
    head -c "$cut" sky.env.exr >cut.env.exr
    run --separate-stderr render-osmesa -q --mesh "$TESTDATA/speed-shape.obj" --env cut.env.exr --size 16x16 -o none.exr
    [ "$status" -eq 3 ] || { echo "cut at $cut: exit $status: $stderr"; return 1; }
    [[ "$stderr" = *cut.env.exr* ]]
    [ ! -e none.exr ]
  done
}

# Every tool that reads an EXR; CUT stands for it.
@test "an EXR that was cut off is refused by every tool, which leaves nothing" {
  local size cut line source
  while read -r source line; do
    [ -e "$source" ] || source=$TESTDATA/$source
    size=$(stat -L -c %s "$source")
    for cut in 0 5 300 $((size / 2)) $((size - 1)); do
      head -c "$cut" "$source" >cut.exr
      # shellcheck disable=SC2086
      run --separate-stderr ${line//CUT/cut.exr} -o none.exr
      [ "$status" -eq 3 ] || { echo "$line, cut at $cut: exit $status: $stderr"; return 1; }
      [[ "$stderr" = *cut.exr* ]] || { echo "$line, cut at $cut: $stderr"; return 1; }
      [ ! -e none.exr ]
    done
  done <<EOF
studio.exr prefilter-envmap -q -e 6 -s 8 CUT
studio.exr relight -q --from D65 --to A CUT
seen.exr sketch-fit -q -i seen.png -b CUT
seen.exr sketch-fit -q -i CUT -b seen.exr
seen.exr paint-pick -q --face CUT@40,25
seen.exr render-osmesa -q --gbuffer CUT --light 0,20
brushed.sbrdf.exr render-osmesa -q --mesh $TESTDATA/box.obj --size 16x16 --env sky.env.exr --texture White=CUT
brushed.sbrdf.exr paint-sbrdf -q CUT
EOF
}

@test "light and paint below the normal range stay numbers in every tool" {
  printf 'sample,geometry,illuminant,observer,L,a,b\n' >tiny.csv
  for angle in 15 45 110; do printf 'd,45as%d,D65,10,1e-310,-4.9e-324,0\n' $angle >>tiny.csv; done
  paint-convert -q tiny.csv -o tiny.xml
  oiiotool --pattern constant:color=1e-40,1e-41,3e-45 32x16 3 -d float -o dim.exr
  while read -r line; do
    # shellcheck disable=SC2086
    run --separate-stderr $line -o "out.${line%% *}.exr"
    [ "$status" -le 1 ] || { echo "$line: exit $status: $stderr"; return 1; }
    ! grep -aqiE '"-?(nan|inf)|[ \t]-?(nan|inf)\b' "out.${line%% *}.exr" || { echo "$line writes what is no number"; return 1; }
  done <<EOF
paint-convert -q tiny.xml --to csv
paint-edit -q tiny.xml --hue-shift 90
paint-stats -q tiny.xml
fit-paint -q -b $TESTDATA/b5.basis.xml tiny.xml
fit-basis -q --lobes 2 --starts 1 tiny.xml
goniogeom-index -q tiny.xml --lights 30,45 --views as15,as45
trompe-fit -q tiny.xml --angle 2
colorsnap -q -l many.xml -k 3 tiny.xml
prefilter-envmap -q -e 6,70 -s 8 dim.exr
relight -q --from D65 --to A dim.exr
EOF
}

@test "numbers below the normal range pass as numbers" {
  printf 'sample,geometry,illuminant,observer,L,a,b\nd,45as15,D65,10,1e-310,-4.9e-324,0\n' >tiny.csv
  paint-convert -q tiny.csv -o tiny.xml
  grep -q 'L="1e-310" a="-5e-324"' tiny.xml
  paint-convert -q tiny.xml --to csv -o back.csv
  grep -q 'd,45as15,D65,10,1e-310,-5e-324,0' back.csv
  run --separate-stderr fit-paint -q -b "$TESTDATA/b5.basis.xml" tiny.xml -o fit.xml
  echo "exit $status: $stderr"
  [ "$status" -le 1 ]
  ! grep -qiE '"-?(nan|inf)' fit.xml || false
}
