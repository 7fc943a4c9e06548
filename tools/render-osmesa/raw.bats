# render-osmesa with light and paints as they were measured: images that it filters and keeps, readings that it fits.
bats_require_minimum_version 1.5.0

setup_file() {
  cd "$BATS_FILE_TMPDIR" || exit 1
  oiiotool "$TESTDATA/studio.exr" --resize:filter=box 64x32 -d float -o small.exr
  paint-convert -q "$TESTDATA/paints.paints.xml#candy_red,silver_fine,jet_black" -o readings.paints.xml
  fit-paint -q readings.paints.xml -o fitted.xml
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  cp "$BATS_FILE_TMPDIR"/*.{exr,xml} .
  export XDG_CACHE_HOME=$BATS_TEST_TMPDIR/caches
  cache=$XDG_CACHE_HOME/goniochrome
  view="--mesh $TESTDATA/speed-shape.obj --size 64x36 --samples 1 --effects auto,-rays"
  draw="render-osmesa $view -p fitted.xml#candy_red --env small.exr"
}

kept() { find "$cache" -name '*.env.exr' | wc -l; }
same() { [ "$(oiiotool "$1" "$2" --diff | tail -1)" = PASS ]; }

@test "an image is filtered once, and shows what prefilter-envmap makes of it" {
  prefilter-envmap -q small.exr -o small.env.exr
  render-osmesa -q $view -p fitted.xml#candy_red --env small.env.exr -o usual.exr
  run $draw -o first.exr --report first.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ "small.exr: filtered by 9 lobes in "[0-9.]+" s, and kept in $cache" ]]
  [ "$(kept)" -eq 1 ]
  jq -e '.results.filtering | .was_kept == false and .time_s > 0' first.json
  run $draw -o second.exr --report second.json
  [ "$status" -eq 0 ]
  [[ ! "$output" =~ filtered ]]
  jq -e '.results.filtering.was_kept' second.json
  same usual.exr first.exr
  same first.exr second.exr
  # Another paint of the basis, and the same image under another name, find the same maps; other lobes do not.
  cp small.exr other.exr
  render-osmesa -q $view -p fitted.xml#silver_fine --env other.exr -o silver.exr
  [ "$(kept)" -eq 1 ]
  render-osmesa -q $view -p readings.paints.xml#candy_red --basis "$TESTDATA/b5.basis.xml" --env small.exr -o five.exr
  [ "$(kept)" -eq 2 ]
}

@test "an image that changes is filtered again" {
  $draw -q -o first.exr
  oiiotool small.exr --mulc 2,1,1 -d float -o small.exr
  run $draw -o second.exr
  [[ "$output" =~ "filtered by 9 lobes" ]]
  [ "$(kept)" -eq 2 ]
  ! same first.exr second.exr || false
}

@test "runs at the same time all end well, and leave one file" {
  for run in 1 2 3 4; do $draw -q -o $run.exr & done
  for run in 1 2 3 4; do wait -n; done
  for run in 2 3 4; do same 1.exr $run.exr; done
  [ "$(find "$cache" -type f | wc -l)" -eq 1 ]
}

@test "--no-cache filters anew and keeps nothing" {
  run $draw --no-cache -o a.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "filtered by 9 lobes" ]]
  [[ ! "$output" =~ "kept in" ]]
  [ ! -e "$cache" ]
  $draw -q -o b.exr
  printf garbage >"$cache"/*.env.exr
  run $draw --no-cache -o c.exr
  [[ "$output" =~ "filtered by 9 lobes" ]]
  same a.exr b.exr
  same a.exr c.exr
}

@test "a damaged file of the cache is made again" {
  $draw -q -o good.exr
  file=$(find "$cache" -name '*.env.exr')
  sum=$(sha1sum <"$file")
  # Cut off, replaced by another text, and with bytes of a map changed.
  for damage in 'truncate -s 5000' 'cp readings.paints.xml' 'dd if=/dev/zero bs=1 count=64 seek=60000 conv=notrunc status=none'; do
    case $damage in
      dd*) $damage of="$file" ;;
      *) $damage "$file" ;;
    esac
    run $draw -o again.exr
    [ "$status" -eq 0 ]
    [[ "$output" =~ "filtered by 9 lobes" ]]
    same good.exr again.exr
    [ "$(sha1sum <"$file")" = "$sum" ]
  done
}

@test "a cache that cannot be written costs a warning, and the picture is made" {
  $draw -q --no-cache -o good.exr
  mkdir -p caches
  : >caches/goniochrome
  run $draw -o file.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "warning: the maps of small.exr are not kept for the next run: $cache: is no folder" ]]
  same good.exr file.exr
  # A folder without the right to write; root has that right everywhere.
  rm caches/goniochrome
  mkdir caches/goniochrome
  chmod a-w caches/goniochrome
  if [ ! -w caches/goniochrome ]; then
    run $draw -o sealed.exr
    [ "$status" -eq 0 ]
    [[ "$output" =~ "are not kept for the next run" ]]
    same good.exr sealed.exr
  fi
  # No room: a file system takes no file larger than this. The picture goes through a pipe.
  run --separate-stderr bash -c "ulimit -f 20; trap '' XFSZ; $draw -o - | cat >full.exr"
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "are not kept for the next run" ]]
  same good.exr full.exr
  [ "$(find caches/goniochrome -type f | wc -l)" -eq 0 ]
}

@test "without a home nothing is kept" {
  run env -u XDG_CACHE_HOME -u HOME $draw -o out.exr
  [ "$status" -eq 0 ]
  [[ "$output" =~ "filtered by 9 lobes" ]]
  [[ ! "$output" =~ "kept in" ]]
  run env -u XDG_CACHE_HOME HOME="$PWD/home" $draw -o out.exr
  [[ "$output" =~ "kept in $PWD/home/.cache/goniochrome" ]]
}

@test "images that are no light are refused, and so is one on a pipe" {
  printf 'no image\n' >text.exr
  run render-osmesa $view --env text.exr -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ text.exr ]]
  oiiotool small.exr --mulc -1,1,1 -d float -o negative.exr
  run render-osmesa $view --env negative.exr -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "prefilter-envmap --bad-pixels zero" ]]
  run render-osmesa $view --env - -o none.exr <small.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "standard input: is no prefiltered environment" ]]
  [ ! -e none.exr ]
}

@test "the check and the engines that sum or trace take the image itself" {
  for engine in cpu integral path; do
    run render-osmesa $view -p fitted.xml#candy_red --env small.exr --engine $engine --tolerance 2 --check 20 -o $engine.exr --report r.json
    [ "$status" -le 1 ]
    [ "$(jq -r .results.error.source r.json)" = small.exr ]
    [ "$engine" != integral ] || [ "$(jq '.results.error.de00_mean < 1' r.json)" = true ]
  done
}

@test "lobes of a texture beyond the basis are filtered too" {
  fit-paint -q "$TESTDATA/paints.paints.xml#candy_red" -o one.xml
  run render-osmesa $view -p one.xml --texture "Body=$TESTDATA/wood.sbrdf.exr,project=box" --env small.exr -o out.exr
  [ "$status" -eq 0 ] || [[ "$output" =~ "no part or material" ]]
  part=$(sed -nE 's/^o //p' "$TESTDATA/speed-shape.obj" | head -1)
  for maps in cubes mip; do
    run render-osmesa $view -p one.xml --texture "$part=$TESTDATA/wood.sbrdf.exr,project=box" --texture-maps $maps --env small.exr -o $maps.exr
    [ "$status" -eq 0 ]
  done
}

@test "readings in every format are fitted to the built-in basis, and give the picture of fit-paint" {
  render-osmesa -q $view -p fitted.xml#candy_red --env small.exr -o fitted.exr
  for format in csv wide cxf cgats xml; do
    case $format in csv | wide) columns="--columns all" ;; *) columns="" ;; esac
    paint-convert -q readings.paints.xml --to $format $columns -o "raw.$format"
    run render-osmesa $view -p "raw.$format#candy_red" --env small.exr -o $format.exr
    [ "$status" -eq 0 ]
    [[ "$output" =~ "candy_red of raw.$format: fitted to b7, dE00 "[0-9.]+" in the mean" ]]
  done
  for format in csv wide cxf cgats xml; do same fitted.exr $format.exr; done
}

@test "a library of readings is drawn as a stream, each paint fitted on the way" {
  paint-convert -q readings.paints.xml --to csv --columns all -o raw.csv
  render-osmesa -q $view -p raw.csv --light 30,40 -o '{name}.exr'
  render-osmesa -q $view -p fitted.xml --light 30,40 -o 'by-hand-{name}.exr'
  for name in candy_red silver_fine jet_black; do same $name.exr by-hand-$name.exr; done
  run render-osmesa $view -p raw.csv --light 30,40 -o one.exr
  [ "$status" -eq 2 ]
  [[ "$output" =~ "raw.csv holds 3 paints" ]]
}

@test "files that hold no paint are refused by name" {
  printf 'nothing here\n' >notes.txt
  run render-osmesa $view --light 30,40 -p notes.txt -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "notes.txt: is neither paint XML nor a table, CxF, CGATS, workbook or file of an instrument" ]]
  printf 'sample,geometry,illuminant,observer,L,a,b\nred,45as15,D65,10,x,1,2\n' >wrong.csv
  run render-osmesa $view --light 30,40 -p wrong.csv -o none.exr
  [ "$status" -eq 3 ]
  [[ "$output" =~ "wrong.csv:2" ]]
  [ ! -e none.exr ]
}
