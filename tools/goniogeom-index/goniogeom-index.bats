# goniogeom-index from the outside: options, figures, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  paints=$TESTDATA/paints.paints.xml
  head='<paints xmlns="urn:goniochrome:paint:1" version="1">'
  gray='<appearance travel="60"><face L="50" a="0" b="0"/><flop L="50" a="0" b="0"/></appearance>'
  echo "$head<paint name=\"gray\" class=\"solid\">$gray</paint></paints>" >gray.xml
}

# column N of the first data row
column() { sed -n 2p | cut -f "$1"; }

@test "a solid paint has the index of the cosine alone, and a much larger one under a light above it" {
  # dE = 66 |cbrt(cos) - cbrt(cos 45)|: the closed form, toward and away from the light.
  for sign in plus:6:1 minus:7:-1; do
    IFS=: read -r _ field s <<<"$sign"
    wanted=$(awk -v s="$s" 'BEGIN { r = atan2(0, -1) / 180; k = cos(45 * r)^(1 / 3) + s * 2.3 / 66
      c = k^3; a = atan2(sqrt(1 - c * c), c) / r; d = a - 45; printf "%.9f", d < 0 ? -d : d }')
    got=$(goniogeom-index gray.xml --views 0 2>/dev/null | column "$field")
    awk -v a="$got" -v b="$wanted" 'BEGIN { d = a - b; exit !(d < 1e-6 && d > -1e-6) }'
  done
  at45=$(goniogeom-index gray.xml --views 0 2>/dev/null | column 7)
  at0=$(goniogeom-index gray.xml --light 0 --view 20 2>/dev/null | column 7)
  awk -v a="$at0" -v b="$at45" 'BEGIN { exit !(a > 3 * b) }'
}

@test "a tab or a line end in a name stays in its field" {
  echo "$head<paint name=\"a&#9;b&#10;c\" class=\"solid\">$gray</paint></paints>" >odd.xml
  goniogeom-index -q odd.xml --views 0 >odd.tsv
  [ "$(wc -l <odd.tsv)" -eq 2 ]
  [ "$(cut -f 1 odd.tsv | tail -n 1)" = "a b c" ]
  [ "$(awk -F'\t' '{ print NF }' odd.tsv | uniq | wc -l)" -eq 1 ]
}

@test "every paint and pair has its row" {
  run --separate-stderr goniogeom-index "$paints" --lights 30,45 --views as15,as45,as110 --report r.json -o i.tsv
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ "59 paints, 6 geometries: smallest index "[0-9.]+" deg (liquid_metal at light" ]]
  [ "$(wc -l <i.tsv)" -eq $((59 * 6 + 1)) ]
  [ "$(jq '.results.paints | length' r.json)" -eq 59 ]
  [ "$(jq '.results.paints[0].geometries | length' r.json)" -eq 6 ]
  [ "$(jq '[.results.paints[].worst_deg] | min == .[0]' r.json)" = false ]
  [ "$(jq '([.results.paints[].worst_deg] | min) == .results.worst_deg' r.json)" = true ]
}

@test "--only, --worst, --out-of-plane, --seam-axis and --target choose what is looked at" {
  [ "$(goniogeom-index "$paints" --only silver_fine -q | wc -l)" -eq 6 ]
  [ "$(goniogeom-index "$paints" --worst -q | wc -l)" -eq 60 ]
  [ "$(goniogeom-index "$paints" --only silver_fine -q --views -20 --out-of-plane 0:90:30 | wc -l)" -eq 5 ]
  across=$(goniogeom-index "$paints" --only silver_fine -q --views 0 | column 6)
  along=$(goniogeom-index "$paints" --only silver_fine -q --views 0 --seam-axis 0 | column 6)
  awk -v a="$along" -v b="$across" 'BEGIN { exit !(a > 2 * b) }'
  [ "$(goniogeom-index "$paints" --only silver_fine -q --target measured)" != "$(goniogeom-index "$paints" --only silver_fine -q)" ]
}

@test "--threshold and --metric move the index" {
  loose=$(goniogeom-index gray.xml -q --views 0 -t 5 | column 6)
  tight=$(goniogeom-index gray.xml -q --views 0 -t 1 | column 6)
  de00=$(goniogeom-index gray.xml -q --views 0 -t 1 --metric de00 | column 6)
  awk -v a="$tight" -v b="$loose" -v c="$de00" 'BEGIN { exit !(a < b && c != a && c < b) }'
  [ "$(goniogeom-index gray.xml -q --views 0 -t 500 | column 6)" = none ]
}

@test "named sets stand for lights and views" {
  for set in instrument showroom outdoor; do
    rows=$(goniogeom-index gray.xml -q --lights set:$set --views set:$set | wc -l)
    [ "$rows" -ge 6 ]
  done
}

@test "--tolerance-for fails the paints that do not hold, by exit status 1" {
  run --separate-stderr goniogeom-index "$paints" --tolerance-for 0.5 -o t.tsv --report r.json
  [ "$status" -eq 1 ]
  [[ "$stderr" =~ "56 stay under 2.3 up to 0.5 deg, 3 do not" ]]
  [ "$(grep -c 'fail$' t.tsv)" -eq 3 ]
  [ "$(jq -r '.results.failing | length' r.json)" -eq 3 ]
  run goniogeom-index gray.xml --tolerance-for 2 -q -o t.tsv
  [ "$status" -eq 0 ]
}

@test "--curve writes CSV and SVG of one paint, for the --misalignments asked" {
  goniogeom-index "$paints" --only silver_fine -q --curve c.csv --curve c.svg --misalignments -2,2 -o i.tsv
  [ "$(head -1 c.csv)" = light_deg,view_deg,aspecular_deg,misalignment_deg,de ]
  [ "$(tail -n +2 c.csv | cut -d, -f4 | sort -u | tr '\n' ' ')" = "-2 2 " ]
  xmllint --noout c.svg
  run goniogeom-index "$paints" -q --curve c.svg -o j.tsv
  [ "$status" -eq 2 ]
  [[ "$output" =~ "choose one by --only" ]]
  [ ! -e j.tsv ]
}

@test "a paint without color is left out by name, the others are done, exit 1" {
  echo "$head<paint name=\"empty\"/><paint name=\"gray\">$gray</paint></paints>" >two.xml
  run --separate-stderr goniogeom-index two.xml
  [ "$status" -eq 1 ]
  [[ "$stderr" =~ "left out: empty: the paint has neither Lab rows nor face, flop and travel" ]]
  [[ "$output" =~ gray ]]
}

@test "an input without a paint is told, exit 1" {
  run --separate-stderr bash -c "echo '$head</paints>' | goniogeom-index"
  [ "$status" -eq 1 ]
  [[ "$stderr" == *"the input holds no paints"* ]]
}

@test "bad options are refused by value, with the remedy" {
  refused() {
    run goniogeom-index gray.xml "${@:2}"
    [ "$status" -eq 2 ]
    [[ "$output" =~ $1 ]]
  }
  refused 'threshold is 0: give a color difference above 0' --threshold 0
  refused 'threshold is "-1"' --threshold -1
  refused 'lights has 95: that light is below the horizon' --lights 95
  refused 'views has "x"' --views x
  refused 'out-of-plane has "y"' --out-of-plane y
  refused 'there are instrument, showroom, outdoor' --views set:garage
  refused 'no pair of light and viewer is left' --views 45
  refused 'give a name that ends in .csv or .svg' --curve c.png
  refused 'tolerance-for is given 2 angles' --tolerance-for 1,2
  refused 'tolerance-for is 0' --tolerance-for 0
  refused 'seam-axis' --seam-axis x
  refused 'metric' --metric de94
  refused 'target' --target both
  refused 'misalignments' --misalignments 100
  run goniogeom-index gray.xml --only nix -o n.tsv
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'no paint is named "nix"' ]]
  [ ! -e n.tsv ]
  run goniogeom-index absent.xml
  [ "$status" -eq 3 ]
}

@test "standard input gives the same bytes for any number of threads, and --explain tells the plan" {
  goniogeom-index -q --threads 1 <"$paints" >a.tsv
  goniogeom-index -q --threads 7 "$paints" -o b.tsv
  cmp a.tsv b.tsv
  run --separate-stderr goniogeom-index --explain gray.xml --lights 45 --views 45,as30
  [[ "$stderr" =~ "1 pairs of light and viewer; left out: 1 within 10 deg of the mirror direction" ]]
}

@test "on the speed shape the bumper is 8 degrees out and the door in line" {
  shape="--mesh $TESTDATA/speed-shape.obj"
  run --separate-stderr goniogeom-index "$paints" --only silver_fine $shape --seam Hood,Bumper_F --report r.json -o s.tsv
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "seam Hood | Bumper_F: 0.99 m, misalignment" ]]
  jq -e '.results | .misalignment_deg.median > 8 and .misalignment_deg.median < 9.2 and .paints[0].de_max > 20 and
    .paints[0].over_threshold == 1 and (.paints[0].seam | length) > 150' r.json
  [ "$(wc -l <s.tsv)" -eq $(($(jq '.results.paints[0].seam | length' r.json) + 1)) ]
  goniogeom-index "$paints" --only silver_fine $shape --seam Door_L,Fender_L --report d.json -q -o d.tsv
  jq -e '.results.misalignment_deg.median | fabs < 0.5' d.json
  [ "$(goniogeom-index "$paints" --only silver_fine $shape --seam Hood,Bumper_F --worst -q | wc -l)" -eq 2 ]
}

@test "--advise tells the five guidelines, --picture draws" {
  run --separate-stderr goniogeom-index "$paints" --only silver_fine --mesh "$TESTDATA/speed-shape.obj" \
    --seam Hood,Bumper_F --advise --picture s.png --report r.json -o s.tsv
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "1 high travel only on parallel panels: applies" ]]
  [ "$(jq '.results.paints[0].advice | length' r.json)" -eq 5 ]
  [ "$(head -c 4 s.png | tail -c 3)" = PNG ]
}

@test "lights, viewers and an environment may stand in the world" {
  shape="--mesh $TESTDATA/speed-shape.obj --seam Hood,Bumper_F"
  near=$(goniogeom-index "$paints" --only silver_fine $shape --light-from 0,75 --view-from 25,20 --worst -q | column 11)
  far=$(goniogeom-index "$paints" --only silver_fine $shape --light-from 180,60 --view-from 180,70 --worst -q | column 11)
  awk -v a="$near" -v b="$far" 'BEGIN { exit !(a > 2 * b) }'
  prefilter-envmap -e 2,8,32 --size 8 "$TESTDATA/studio.exr" -o e.env.exr -q
  env=$(goniogeom-index "$paints" --only silver_fine $shape --environment e.env.exr --view-from 25,20 --worst -q | column 11)
  awk -v a="$env" 'BEGIN { exit !(a > 2 && a < 40) }'
}

@test "a mesh in the way of an environment's light is traced, and --open leaves it out" {
  # Two level panels and a high wall beyond the second one, in even light. The wall hides more than a quarter of the sky
  # from both edges; how exactly it does so is tested with the library.
  awk 'BEGIN { for (i = 0; i < 3; ++i) { x = i == 0 ? -1 : i == 1 ? 0.005 : 1; y = i == 0 ? 0 : i == 1 ? 1 : 1
      if (i < 2) printf "v %g 0 9\nv %g 0 9\nv %g 0 -9\nv %g 0 -9\n", x, y, y, x
      else printf "v 1 0 9\nv 1 2 9\nv 1 2 -9\nv 1 0 -9\n" }
    print "o A\nf 1 2 3 4\no B\nf 5 6 7 8\no Wall\nf 12 11 10 9" }' >wall.obj
  oiiotool --create 32x16 3 --fill:color=0.5,0.5,0.5 32x16 -o even.exr
  prefilter-envmap -e 2,8,32 --size 8 even.exr -o even.env.exr -q
  seam="--mesh wall.obj --seam A,B --environment even.env.exr --view-from -90,60"
  run --separate-stderr goniogeom-index "$paints" --only jet_black $seam --worst --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "the mesh changes differences by "[0-9.]+" (95 % of the views), known to " ]]
  jq -e '.results.traced[0] | .paint == "jet_black" and .panels_not_found == 0 and .noise_de76 < 0.3' r.json
  run --separate-stderr goniogeom-index "$paints" --only jet_black $seam --open --worst --report o.json
  [[ ! "$stderr" =~ "the mesh changes" ]]
  jq -e '.results | has("traced") | not' o.json
  # The coat that gloss implies counts here too. How much light it lets in beside a wall is tested with the library.
  sed 's|<gloss angle|<coat index="1"/><gloss angle|' "$paints" >bare.xml
  bare=$(goniogeom-index bare.xml --only arctic_white $seam --worst -q | column 11)
  coated=$(goniogeom-index "$paints" --only arctic_white $seam --worst -q | column 11)
  awk -v a="$bare" -v b="$coated" 'BEGIN { exit !(a > 0 && (b > 1.05 * a || b < 0.95 * a)) }'
  prefilter-envmap -e 2,8,32 --size 8 --no-mirror even.exr -o bare.env.exr -q
  run --separate-stderr goniogeom-index "$paints" --only jet_black --mesh wall.obj --seam A,B --environment bare.env.exr \
    --view-from -90,60 --worst
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"has no mirror part"*"shadows and reflections of the mesh on itself are left out"* ]]
  run goniogeom-index "$paints" --only jet_black --mesh wall.obj --seam A,B --open
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--open is about the light of an environment" ]]
}

@test "--unit and --max-gap decide what is a seam" {
  awk '$1 == "v" { printf "v %.9g %.9g %.9g\n", $2 * 1000, $3 * 1000, $4 * 1000; next } { print }' \
    "$TESTDATA/speed-shape.obj" >mm.obj
  run --separate-stderr goniogeom-index "$paints" --only silver_fine --mesh mm.obj --seam Hood,Bumper_F --worst
  [[ "$stderr" =~ "0.99 m, misalignment" ]]
  [[ "$stderr" =~ "taken as millimeters (--unit says otherwise)" ]]
  run --separate-stderr goniogeom-index "$paints" --only silver_fine --mesh mm.obj --unit cm --seam Hood,Bumper_F --worst
  [[ "$stderr" =~ "9.95 m, misalignment" ]]
  run goniogeom-index "$paints" --only silver_fine --mesh mm.obj --max-gap 3 --seam Hood,Bumper_F
  [ "$status" -eq 3 ]
  [[ "$output" =~ "do not touch: their edges are" ]]
}

@test "bad seams are refused by name" {
  shape="--mesh $TESTDATA/speed-shape.obj"
  run goniogeom-index gray.xml $shape --seam Hood,Dorr_L
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'speed-shape.obj: the mesh has no part "Dorr_L": it has Hood, Fender_L' ]]
  run goniogeom-index gray.xml $shape --seam Roof,Bumper_F
  [ "$status" -eq 3 ]
  [[ "$output" =~ '"Roof" and "Bumper_F" do not touch: their edges are 17'.*' mm apart at the nearest' ]]
  seam_refused() {
    run goniogeom-index gray.xml "${@:2}"
    [ "$status" -eq 2 ]
    [[ "$output" =~ $1 ]]
  }
  seam_refused 'give --mesh' --seam Hood,Roof
  seam_refused 'give --mesh' --advise
  seam_refused 'name two parts of the mesh, A,B' $shape --seam Hood
  seam_refused 'leave out --mesh' $shape --seam Hood,Bumper_F --tolerance-for 1
  seam_refused 'ends in .png' $shape --seam Hood,Bumper_F --picture x.jpg
  seam_refused 'give --view-from AZ,EL' $shape --seam Hood,Bumper_F --light-from 0,50
  seam_refused 'wants --light-from or --environment' $shape --seam Hood,Bumper_F --view-from 0,50
  seam_refused 'light-from is "north"' $shape --seam Hood,Bumper_F --light-from north
  seam_refused 'view-from is "0,100"' $shape --seam Hood,Bumper_F --light-from 0,1 --view-from 0,100
  seam_refused 'exclude each other' $shape --seam Hood,Bumper_F --light-from 0,50 --environment x --view-from 0,3
  seam_refused 'unit' $shape --seam Hood,Bumper_F --unit inch
  seam_refused 'max-gap' $shape --seam Hood,Bumper_F --max-gap -1
  run goniogeom-index "$paints" $shape --seam Hood,Bumper_F --picture x.png -q -o x.tsv
  [ "$status" -eq 2 ]
  [[ "$output" =~ "choose one by --only, or write {name} in the name of the file" ]]
}

# Two spectra whose colors part in one light only: the flop is the face with more red, which daylight lamps hide.
@test "--illuminant judges paints in several lights, and the smallest index is that of all" {
  spectrum() { awk -v red="$2" -v scale="$3" -v g="$1" 'BEGIN {
    printf "<spectrum geometry=\"%s\" from=\"400\" step=\"10\" to=\"700\">", g
    for (nm = 400; nm <= 700; nm += 10) printf "%s%g", (nm > 400 ? " " : ""), scale * (0.2 + red * (nm > 640))
    print "</spectrum>" }'; }
  {
    echo "$head<paint name=\"turning\"><measurement illuminant=\"D65\" observer=\"10\"><lab geometry=\"45as15\" L=\"50\" a=\"0\" b=\"0\"/>"
    spectrum 45as15 0 1
    spectrum 45as45 0.3 1
    spectrum 45as110 0.9 1
    echo "</measurement></paint><paint name=\"gray\" class=\"solid\">$gray</paint></paints>"
  } >spectra.xml
  run --separate-stderr goniogeom-index spectra.xml --views 0 --light 45 --illuminant D65,A
  [ "$status" -eq 1 ]
  [[ "$stderr" == *'paint "gray": it has no readings'* ]]
  [ "${#lines[@]}" -eq 3 ]
  [ "$(cut -f11 <<<"${lines[0]}")" = illuminant ]
  [ "$(cut -f11 <<<"${lines[1]}") $(cut -f11 <<<"${lines[2]}")" = "D65 A" ]
  # A lamp has more red, so that the paint turns faster there.
  awk -v a="$(cut -f8 <<<"${lines[2]}")" -v b="$(cut -f8 <<<"${lines[1]}")" 'BEGIN { exit !(a != b) }'
  run --separate-stderr goniogeom-index spectra.xml#turning --views 0 --light 45 --illuminant D65,A --worst
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -eq 2 ]
  # The figures are those by way of paint-convert.
  diff <(goniogeom-index -q spectra.xml#turning --views 0 --light 45 --illuminant A | cut -f1-10) \
    <(paint-convert -q spectra.xml#turning --illuminant A | goniogeom-index -q --views 0 --light 45)
  run goniogeom-index spectra.xml --illuminant X
  [ "$status" -eq 2 ]
}

# coated INDEX FILE: the gray paint under such a coat.
coated() { echo "$head<paint name=\"gray\" class=\"solid\">${gray}<coat index=\"$1\"/></paint></paints>" >"$2"; }

@test "a coat that the paint states takes light at steep angles; an index of 1 is no coat" {
  coated 1 bare.xml
  coated 1.5 coat.xml
  diff <(goniogeom-index -q gray.xml --light 60 --view 70) <(goniogeom-index -q bare.xml --light 60 --view 70)
  # dE at the index is that of cos T(light) T(viewer), relative to where the reading is taken.
  got=$(goniogeom-index -q coat.xml --light 60 --view 70 | column 6)
  awk -v b="$got" 'function fresnel(d,  c, g) {
      c = cos(d * r); g = sqrt(1.25 + c * c)
      return (((c - g) / (c + g)) ^ 2 + ((2.25 * c - g) / (2.25 * c + g)) ^ 2) / 2
    }
    function shade(b,  as, read) {
      as = 10 + 2 * b
      read = as < 45 ? 45 - as : as - 45; if (read > 65) read = 65
      return cos((60 - b) * r) * (1 - fresnel(60 - b)) * (1 - fresnel(70 + b)) / ((1 - fresnel(45)) * (1 - fresnel(read)))
    }
    BEGIN { r = atan2(0, -1) / 180; d = 66 * (shade(b) ^ (1 / 3) - shade(0) ^ (1 / 3)); if (d < 0) d = -d
      exit !(d > 2.2999 && d < 2.3001) }'
  without=$(goniogeom-index -q gray.xml --light 60 --view 70 | column 6)
  awk -v a="$got" -v b="$without" 'BEGIN { d = a - b; exit !(d > 0.1 || d < -0.1) }'
}

@test "pairs that are left out are told and reported" {
  run --separate-stderr goniogeom-index gray.xml --lights 0,45 --views 0,-40 --report r.json -o i.tsv
  [ "$status" -eq 0 ]
  [ "$(wc -l <i.tsv)" -eq 4 ]
  [[ "$stderr" == *"left out: 1 of the pairs of light and viewer (0/0 deg), within 10 deg of the mirror direction"* ]]
  jq -e '.results.left_out == [{"light_deg": 0, "view_deg": 0, "azimuth_deg": 0, "aspecular_deg": 0}]' r.json
  run --separate-stderr goniogeom-index gray.xml --lights 80 --views as45,as175 -o i.tsv
  [[ "$stderr" == *"left out: 1 viewers that lie below the horizon of the panel"* ]]
  run --separate-stderr goniogeom-index gray.xml --report r.json -o i.tsv
  [[ "$stderr" != *"left out"* ]]
  jq -e '.results.left_out == []' r.json
}

# The coat that gloss implies belongs to the paint and not to the file that it comes in. Control: a file that says that
# there is none.
@test "a paint has the same index from its plain file, from its fitted file and from tables" {
  fit-paint -q "$paints" -o fitted.xml
  fit-paint -q --coat none "$paints" -o bare.xml
  paint-convert -q "$paints" --to wide --columns all -o wide.csv
  paint-convert -q "$paints" -o all.cxf
  goniogeom-index -q "$paints" -o plain.tsv
  for other in fitted.xml wide.csv all.cxf; do
    goniogeom-index -q "$other" -o other.tsv
    paste plain.tsv other.tsv | awk -F'\t' 'NR > 1 { if ($1 != $11) exit 1
      for (i = 6; i <= 10; ++i) { d = $i - $(i + 10); if (d > 1e-6 || d < -1e-6 || ($i == "none") != ($(i + 10) == "none")) exit 1 } }'
  done
  goniogeom-index -q bare.xml -o bare.tsv
  paste plain.tsv bare.tsv | awk -F'\t' '$1 == "silver_fine" { d = $7 - $17; most = d > most ? d : d < -most ? -d : most } END { exit !(most > 1) }'
}

# Toward the mirror direction a metallic paint grows brighter; held constant, it would differ by its shading alone.
@test "both sides of a viewer near the mirror direction have an index of the same size" {
  goniogeom-index -q "$paints#silver_fine" --views as15 --target measured -o near.tsv
  awk -F'\t' 'NR == 2 { exit !($6 < 1.5 * $7 && $7 < 1.5 * $6) }' near.tsv
}

@test "pairs in the mirror direction are refused for any paint, with a viewer who sees the same of a solid one" {
  run --separate-stderr goniogeom-index gray.xml --lights 0 --views 0
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"where gloss covers the color of any paint"*"as by --views as20"* ]]
}

@test "--curve - is a table for draw-plot" {
  goniogeom-index -q "$paints#silver_fine" --lights 30,45 --curve - -o i.tsv >curve.csv
  [ "$(head -n 1 curve.csv)" = light_deg,view_deg,aspecular_deg,misalignment_deg,de ]
  # In the mirror direction there is no difference, and the line breaks.
  grep -Eq '^30,30,[-0-9.e]+,1,$' curve.csv
  draw-plot curve.csv --series light_deg,misalignment_deg --x view_deg --y de -o curve.svg
  grep -q '>light_deg 30, misalignment_deg 1<' curve.svg
  run --separate-stderr goniogeom-index -q "$paints#silver_fine" --curve -
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"both to go to standard output"* ]]
}
