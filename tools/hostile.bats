# What no tool may do with files, names and surroundings that nobody would wish for: end by a signal or as a bug, run on, or
# take memory out of proportion.
bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
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
  refused "a.ply: the library that reads it crashed" render-osmesa --mesh a.ply --light 0,20 --size 16x16 -o x.png
  refused "a.ply: the library that reads it crashed" goniogeom-index --seam a,b --mesh a.ply "$TESTDATA/paints.paints.xml"
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
  [ -L second.csv ] && [ -L link.csv ]
  [ "$(wc -l <there/x.csv)" -gt 1 ]
  [ "$(stat -c %a there/x.csv)" = 640 ]
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o loose.csv
  [ -L loose.csv ] && cmp there/new.csv there/x.csv
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

@test "a forbidden folder is an error of input" {
  [ "$(id -u)" -eq 0 ] || skip "only root can become somebody else"
  mkdir forbidden
  cp "$TESTDATA/paints.paints.xml" forbidden/p.xml
  chmod 700 forbidden
  mkdir mine
  chmod 755 "$BATS_TEST_TMPDIR"
  chown 65534 mine
  cp "$TESTDATA/paints.paints.xml" mine/p.xml
  chmod 644 mine/p.xml
  local as_nobody="setpriv --reuid 65534 --clear-groups"
  $as_nobody test -r mine/p.xml || skip "the scratch folder is closed to others"
  refused "forbidden" $as_nobody paint-convert -q forbidden/p.xml --to csv
  for option in -o --report; do
    refused "forbidden" $as_nobody paint-convert -q mine/p.xml --to csv $option forbidden/x.csv
  done
  refused "forbidden" $as_nobody plot-paint -q mine/p.xml --pages forbidden/deep
  refused "forbidden" $as_nobody prefilter-envmap -q -e 6 -s 8 "$TESTDATA/studio.exr" -o mine/x.exr --cache forbidden/deep
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
