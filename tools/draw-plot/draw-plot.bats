# draw-plot from the outside: the table, the axes, and what is wrong with either.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  printf 'series,x,y,style\nours,1,0.1,both\nours,10,0.01,both\nbrute force,100,0,points\nbrute force,50,1e-6,points\n' >t.csv
}

@test "series become lines and points with a legend" {
  draw-plot t.csv --title 'error against time' --x-label 'time (ms)' --y-label 'error' --width 500 --height 300 -o p.svg
  xmllint --noout p.svg
  grep -q '>error against time<' p.svg
  grep -q '>time (ms)<' p.svg
  grep -q '>brute force<' p.svg
  grep -q 'width="500" height="300"' p.svg
  # One line, of "ours"; a circle for each of four points and two in the legend.
  [ "$(grep -o '<path class="curve"[^>]*L[0-9]' p.svg | wc -l)" -eq 1 ]
  [ "$(grep -o '<circle' p.svg | wc -l)" -eq 6 ]
}

@test "standard input goes to standard output" {
  draw-plot <t.csv | xmllint --noout -
}

@test "a logarithmic axis leaves out what is not above 0, and says so" {
  run --separate-stderr draw-plot t.csv --logarithmic both -o p.svg --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" == *'1 points of "brute force" are not above 0'* ]]
  [ "$(jq '.results.series[1].left_out' r.json)" -eq 1 ]
  [ "$(grep -o '<circle' p.svg | wc -l)" -eq 5 ]
}

@test "columns of any table become series, x and y" {
  printf 'paint\tlight\tangle\tde\na\t30\t1\t0.5\na\t30\t2\tnone\na\t45\t1\t0.7\nb\t30\t1\t-\n' >t.tsv
  draw-plot t.tsv --series paint,light --x angle --y de --style points --report r.json -o p.svg
  jq -e '[.results.series[].label] == ["paint a, light 30", "paint a, light 45", "paint b, light 30"]' r.json
  grep -q '>angle<' p.svg
  # Two points have numbers; three stand in the legend.
  [ "$(grep -o '<circle' p.svg | wc -l)" -eq 5 ]
  run --separate-stderr draw-plot t.tsv --x angel -o none.svg
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'t.tsv:1: there is no heading series'*'--series, --x and --y: paint, light, angle, de'* ]]
}

@test "rings go around points, in the color given" {
  printf 'series,x,y,style,color\nall,1,2,both,\nall,2,3,both,\nchosen,2,3,rings,#123abc\n' >t.csv
  draw-plot t.csv -o p.svg
  [ "$(grep -o '<circle' p.svg | wc -l)" -eq 5 ]
  # One in the plot, one in the legend; the other series keeps the first color of the palette.
  [ "$(grep -o 'r="6.5" fill="none" stroke="#123abc"' p.svg | wc -l)" -eq 2 ]
  [ "$(grep -o 'fill="#0072b2"' p.svg | wc -l)" -eq 3 ]
}

# refused STATUS MESSAGE COMMAND...: nothing is written.
refused() {
  local wanted=$1 message=$2
  shift 2
  run --separate-stderr "$@" -o none.svg
  [ "$status" -eq "$wanted" ]
  [[ "$stderr" == *"$message"* ]]
  [ ! -e none.svg ]
}

@test "a bad table is told by line, value and remedy" {
  printf 'series,x\na,1\n' >bad.csv
  refused 3 'bad.csv:1: there is no heading y' draw-plot bad.csv
  printf 'series,x,y\na,1,2\nb,1,two\n' >bad.csv
  refused 3 'bad.csv:3: y is "two": write a number' draw-plot bad.csv
  printf 'series,x,y\na,1\n' >bad.csv
  refused 3 'bad.csv:2: 2 cells where the headings are 3' draw-plot bad.csv
  printf 'series,x,y,style\na,1,2,thick\n' >bad.csv
  refused 3 'style is "thick": give line, points, both, dashed or rings' draw-plot bad.csv
  printf 'series,x,y,color\na,1,2,red\n' >bad.csv
  refused 3 'bad.csv:2: color is "red": give #rrggbb' draw-plot bad.csv
  printf 'series,x,y\n' >bad.csv
  refused 3 'nothing to draw' draw-plot bad.csv
  refused 3 'none.csv' draw-plot none.csv
}

@test "wrong values are refused by name" {
  refused 2 '--logarithmic is "z": give none, x, y, both' draw-plot t.csv --logarithmic z
  refused 2 '--width is "10"' draw-plot t.csv --width 10
  run --separate-stderr draw-plot t.csv -o none.svg --title
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'--title needs a value'* ]]
}
