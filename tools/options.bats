#!/usr/bin/env bats
# Every option of every tool: without its value, with a wrong one, and with the one that its man page gives as an example.
# What an option does is tested beside its tool.

setup() {
  cd "$BATS_TEST_TMPDIR"
  top=$(cd "$BATS_TEST_DIRNAME/.." && pwd)
  tools=$(cd "$top/tools" && printf '%s\n' */ | tr -d /)
}

# options TOOL: one line for each option that takes a value: its name; `required` or `-`; and `bounded` where it is a
# number with two bounds, `checked` where it is another number or a choice, else `free`.
options() {
  "$1" --generate=man | sed 's/\\-/-/g; s/\\f[BIR]//g' | awk '
    /^\.TP/ { head = 1; next }
    head && /^(-[a-z], )?--[a-z]/ { name = $0; sub(/^-., /, "", name); split(name, word, " "); name = word[1]; value = word[2]; head = 0; next }
    name != "" && value != "" {
      print name, /The option is required/ ? "required" : "-", /The value is [^.]*from -?[0-9.]+ to / ? "bounded" : /The value is (one of |.* or more\.|.* or less\.)/ ? "checked" : "free"
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
    done < <(options "$tool")
  done
  [ "$checked" -gt 200 ]
}

@test "a value that is no choice or out of the domain is a usage error that says what is right" {
  checked=0
  for tool in $tools; do
    required=$(options "$tool" | awk '$2 == "required" { print $1 "=x" }')
    while read -r option _ kind; do
      [ "$kind" != free ] || continue
      values=(wrong '')
      [ "$kind" = checked ] || values+=(1e299 -1e299)
      for value in "${values[@]}"; do
        run "$tool" $required "$option=$value"
        [ "$status" -eq 2 ] || { echo "$tool $option=$value: $status"; false; }
        [[ "$output" == "$tool: $option "*": give "* || "$output" == *"needs a value"* || "$output" == *"too large"* ]] || { echo "$output"; false; }
        checked=$((checked + 1))
      done
    done < <(options "$tool")
  done
  [ "$checked" -gt 200 ]
}

@test "every option has a heading, a unit and an example that it takes" {
  for tool in $tools; do
    run "$tool" --generate=man
    [ "$status" -eq 0 ] || { echo "$output"; false; }
  done
}
