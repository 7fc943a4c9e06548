#!/usr/bin/env bash
# Holds that what is compiled for the page takes no elementary function from a C library: it would differ in the last bits
# from what the tools compute. lib/math/elementary.h has them.
#
#   arithmetic_test.sh SOURCE...
set -euo pipefail
functions='\b(std::)(cbrt|hypot|atan2?|acos|asin|sinh?|cosh?|tanh?|exp2?|expm1|log(1p|2|10)?|pow)\('

# The control: where the functions themselves stand, those of the C library are called for what is no number.
own=() others=()
for source in "$@"; do
  case $source in */math/elementary_*.cpp) own+=("$source") ;; *) others+=("$source") ;; esac
done
[ "${#own[@]}" -eq 2 ] && [ "${#others[@]}" -gt 50 ]
grep -qE "$functions" "${own[@]}"

if grep -nE "$functions" "${others[@]}"; then
  echo "take these functions from math/elementary.h"
  exit 1
fi
