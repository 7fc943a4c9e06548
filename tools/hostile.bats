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
