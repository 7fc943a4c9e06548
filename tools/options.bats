#!/usr/bin/env bats
# Every option of every tool: without its value, with a wrong one, and with the one that its man page gives as an example.
# What an option does is tested beside its tool.

# The options of each tool in a file of its name.
setup_file() {
  local tool
  for tool in $(cd "$BATS_TEST_DIRNAME" && printf '%s\n' */ | tr -d /); do
    options "$tool" >"$BATS_FILE_TMPDIR/$tool"
  done
}

setup() {
  cd "$BATS_TEST_TMPDIR"
  top=$(cd "$BATS_TEST_DIRNAME/.." && pwd)
  tools=$(cd "$top/tools" && printf '%s\n' */ | tr -d /)
}

# options TOOL: one line for each option that takes a value: its name; `required` or `-`; and `bounded` where it is a
# number with two bounds, `checked` where it is another number or a choice, else `free`; and a value that it takes, if it is a
# choice, else x.
options() {
  "$1" --generate=man | sed 's/\\-/-/g; s/\\f[BIR]//g' | awk '
    /^\.TP/ { head = 1; next }
    head && /^(-[a-z], )?--[a-z]/ { name = $0; sub(/^-., /, "", name); split(name, word, " "); name = word[1]; value = word[2]; head = 0; next }
    name != "" && value != "" {
      print name, / Required\./ ? "required" : "-", /Value: [^.]*from -?[0-9.]+ to / ? "bounded" : /Value: (one of |.* or more\.|.* or less\.)/ ? "checked" : "free", match($0, /one of [^ ,.]+/) ? substr($0, RSTART + 7, RLENGTH - 7) : "x"
    }
    { name = ""; head = 0 }'
}

@test "an option without its value is a usage error that names it" {
  checked=0
  for tool in $tools; do
    while read -r option _; do
      run "$tool" "$option"
      [ "$status" -eq 2 ] || { echo "$tool $option: $status"; false; }
      [[ "$output" == "$tool: $option needs a value"* ]] || { echo "$output"; false; }
      checked=$((checked + 1))
    done <"$BATS_FILE_TMPDIR/$tool"
  done
  [ "$checked" -gt 200 ]
}

@test "a value that is no choice or out of the domain is a usage error that says what is right" {
  checked=0
  for tool in $tools; do
    while read -r option _ kind _; do
      [ "$kind" != free ] || continue
      required=$(awk -v asked="$option" '$2 == "required" && $1 != asked { print $1 "=" $4 }' "$BATS_FILE_TMPDIR/$tool")
      values=(wrong '')
      [ "$kind" = checked ] || values+=(1e299 -1e299)
      for value in "${values[@]}"; do
        run "$tool" $required "$option=$value"
        [ "$status" -eq 2 ] || { echo "$tool $option=$value: $status"; false; }
        [[ "$output" == "$tool: $option "*": give "* || "$output" == *"needs a value"* || "$output" == *"too large"* ]] || { echo "$output"; false; }
        checked=$((checked + 1))
      done
    done <"$BATS_FILE_TMPDIR/$tool"
  done
  [ "$checked" -gt 200 ]
}

@test "every option has a heading, a unit and an example that it takes" {
  for tool in $tools; do
    run "$tool" --generate=man
    [ "$status" -eq 0 ] || { echo "$output"; false; }
    [ "$("$tool" --generate man)" = "$output" ]
  done
}

@test "FILE#NAMES names some paints of a file in every tool that reads paints" {
  ln -s "$top/testdata" testdata
  library=testdata/paints.paints.xml
  names() { grep -o '<paint name="[^"]*"' | cut -d'"' -f2 | paste -sd' '; }
  [ "$(paint-convert -q "$library#candy_red" | names)" = candy_red ]
  [ "$(paint-edit -q --hue-shift 1 "$library#candy_red" | names)" = candy_red ]
  silvers=$(paint-convert -q "$library#silver_*" | names)
  [[ "$silvers" == *" "* ]]
  [[ "$silvers" != *candy* ]]
  [ "$(fit-paint -q --basis "$top/testdata/b7.basis.xml" "$library#silver_*" -o fitted.xml && names <fitted.xml)" = "$silvers" ]
  [ "$(paint-stats -q "$library#silver_*" | tail -n +2 | cut -f1 | paste -sd' ')" = "$silvers" ]
  [ "$(goniogeom-index -q --worst "$library#candy_red,silver_*" 2>/dev/null | tail -n +2 | wc -l)" -eq $((1 + $(wc -w <<<"$silvers"))) ]
  [ "$(colorsnap -q -k 1 -l "$library#silver_*" "$library#candy_red" | sed -n 2p | cut -f3 | grep -c silver)" -eq 1 ]
  plot-paint -q fitted.xml#silver_fine -o sheet.svg
  fit-basis -q --lobes 2 "$library#silver_fine" -o two.basis.xml
  trompe-fit -q "$library#silver_fine" --angle 2 -o b.xml
  prefilter-envmap -q --for fitted.xml#silver_fine -s 8 "$top/testdata/studio.exr" -o o.exr
  for tool in paint-convert "paint-edit --hue-shift 1" paint-stats goniogeom-index plot-paint "fit-paint --basis testdata/b7.basis.xml" \
    "fit-basis --lobes 2" "trompe-fit --angle 2"; do
    # shellcheck disable=SC2086
    run $tool "$library#nobody"
    [ "$status" -eq 3 ] || { echo "$tool: $status $output"; false; }
    [[ "$output" == *'no paint is named "nobody"'* ]] || { echo "$tool: $output"; false; }
  done
}
