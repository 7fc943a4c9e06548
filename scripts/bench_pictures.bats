#!/usr/bin/env bats
# The benchmark of default pictures, on a small one.

bats_require_minimum_version 1.5.0

setup() {
  bench=$(realpath "$BATS_TEST_DIRNAME/bench_pictures.py")
  unset GONIOCHROME_DATA
}

@test "a picture has one row, with its cost, its error and what was told" {
  run --separate-stderr "$bench" --size 96x54 --only 'speed-shape studio candy_red'
  echo "$output"
  [ "$status" -le 1 ]
  [ "${#lines[@]}" -eq 2 ]
  read -r _ _ _ size seconds processor memory mean p95 noise error _ <<<"${lines[1]}"
  [ "$size" = 96x54 ]
  awk "BEGIN { exit !($seconds > 0 && $processor > 0 && $memory > 10 && $mean > 0 && $p95 > $mean && $p95 < 5 && $noise > 0 && $error >= $noise) }"
}

@test "what cannot be drawn is said" {
  run --separate-stderr "$bench" --size small --only 'speed-shape studio candy_red'
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'--size is "small"'* ]]
  run --separate-stderr "$bench" --only boat
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'no picture has boat in its name'* ]]
  run --separate-stderr "$bench" --only
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'expected one argument'* ]]
}
