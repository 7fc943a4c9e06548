#!/usr/bin/env bash
# The order of the modules: an #include under lib/ never points to a later module, `cli` stands on base alone, and no
# third-party type that belongs inside one module shows in a public header.
set -euo pipefail
cd "$(dirname "$0")/../lib"

order=(base math color paint brdf image envmap mesh fit render report fuzz)
declare -A rank
for i in "${!order[@]}"; do rank[${order[i]}]=$i; done

wrong=0
complain() {
  echo "$*"
  wrong=1
}
while IFS=: read -r file _ include; do
  file=${file#./}
  from=${file%%/*}
  to=$(sed -E 's/.*"([a-z]+)\/.*/\1/' <<<"$include")
  if [ "$from" = cli ]; then
    case $to in cli | base) ;; *) complain "$file includes $to: cli stands on base alone" ;; esac
  elif [ "$to" = cli ]; then
    complain "$file includes cli: only tools do"
  elif [ "${rank[$to]:-99}" -gt "${rank[$from]}" ]; then
    complain "$file includes $to, which stands above $from"
  fi
done < <(grep -rnE '^#include "[a-z]+/' --include='*.h' --include='*.cpp' .)

# A header that says "Internal to" is no public one.
while read -r line; do complain "$line: belongs in a .cpp"; done < <(
  grep -rLE '^// .*Internal to lib/' --include='*.h' . |
    xargs grep -nE '^#include <(Eigen|ceres|CGAL|Clp|Coin|OpenImageIO|OpenColorIO|libxml|lcms2|jpeglib|GL/|CLI)' || true)

grep -rqE '^#include "base/' --include='*.cpp' . || complain "nothing was checked"
exit $wrong
