#!/usr/bin/env bats
# The scripts of a newcomer where something is missing: packages, rights, space, a place. Programs of the system are replaced by
# small ones of their names, so nothing is installed and nothing is built.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR"
  scripts=$(realpath "$BATS_TEST_DIRNAME/..")
  mkdir bin
  PATH=$PWD/bin:/usr/bin:/bin
  unset DISPLAY WAYLAND_DISPLAY GONIOCHROME_BUILD_FOLDER
}

# program NAME LINE...: a program of this name, as a shell script of these lines.
program() {
  local name=$1
  shift
  printf '%s\n' '#!/bin/bash' "$@" >"bin/$name"
  chmod +x "bin/$name"
}

# ends STATUS SENTENCE COMMAND...: the command ends with this status, and the last line that it says has the sentence.
ends() {
  local wanted=$1 sentence=$2
  shift 2
  run --separate-stderr "$@"
  [ "$status" -eq "$wanted" ] || { echo "status $status: $stderr"; return 1; }
  [[ ${stderr_lines[-1]} == *"$sentence"* ]] || { echo "$stderr"; return 1; }
}

# install_says TEXT: what installing a package ends with where apt-get says the text.
install_says() {
  program dpkg-query 'exit 1'
  program id 'echo 0'
  program apt-get "[ \"\$1\" = update ] || { printf '%s\\n' \"$1\" >&2; exit 100; }"
  ends 3 "$2" bash -c 'source "$1/common.sh" && install libgood-dev libbad-dev' demo "$scripts"
}

# tools: programs that write their output, and a report with an error.
tools() {
  local name
  for name in fit-paint prefilter-envmap render-osmesa paint-convert paint-studio; do
    program "$name" 'while [ $# -gt 1 ]; do
      case $1 in
        -o) echo made >"$2" ;;
        --report) echo "{\"results\": {\"error\": {\"de00_mean\": 0.5, \"de00_p95\": 1.25}}}" >"$2" ;;
      esac
      shift
    done'
  done
}

@test "the modules that scripts share" {
  for test in "$scripts"/shared/*_test.py; do /usr/bin/python3 "$test"; done
}

@test "packages that cannot be installed end with what to do" {
  install_says 'E: Unable to locate package libbad-dev' 'has no package libbad-dev: use Debian 12 or 13, or a wheel'
  install_says "E: Package 'libbad-dev' has no installation candidate" 'has no package libbad-dev: use Debian 12 or 13, or a wheel'
  install_says "W: Failed to fetch http://x/y  Temporary failure resolving 'x'
E: Unable to locate package libbad-dev" 'check the network, the mirror and the proxy'
  install_says "E: You don't have enough free space in /var/cache/apt/archives/." 'the disk is full: free a few GB'
  install_says 'E: Could not get lock /var/lib/dpkg/lock-frontend' 'another program is installing packages'
  install_says 'E: Sub-process /usr/bin/dpkg returned an error code (1)' 'the packages are not installed: E: Sub-process'
}

@test "packages where nobody may install them, and where there is no apt" {
  program dpkg-query 'exit 1'
  program id 'echo 1000'
  for name in bash basename dirname realpath; do ln -s "$(command -v $name)" "bin/$name"; done
  program apt-get 'echo must not run; exit 1'
  ends 3 'takes root: run this as root, or install sudo, or have installed: libbad-dev' \
    env PATH="$PWD/bin" bash -c 'source "$1/common.sh" && install libbad-dev' demo "$scripts"
  rm bin/apt-get
  ends 3 'this system has no apt-get: use a wheel' env PATH="$PWD/bin" bash -c 'source "$1/common.sh" && install libbad-dev' demo "$scripts"
}

@test "sudo keeps apt-get from asking" {
  program dpkg-query 'exit 1'
  program id 'echo 1000'
  program sudo 'unset DEBIAN_FRONTEND LC_ALL; exec "$@"'
  program apt-get 'echo "$1 ${DEBIAN_FRONTEND:-asks}" >>said'
  bash -c 'source "$1/common.sh" && install libbad-dev' demo "$scripts"
  [ "$(tail -n 1 said)" = 'install noninteractive' ]
}

@test "a checkout that cannot be written is built elsewhere" {
  program dpkg-query 'echo install ok installed'
  program cmake 'exit 0'
  program ctest 'exit 0'
  for script in demo test; do
    ends 3 'set GONIOCHROME_BUILD_FOLDER to a folder of your own' env GONIOCHROME_BUILD_FOLDER=/dev/null/build "$scripts/$script"
  done
  run env GONIOCHROME_BUILD_FOLDER="$PWD/my builds" "$scripts/test"
  [ "${lines[-1]}" = '0 passed, 0 failed, 0 skipped' ]
  [ -d 'my builds' ]
}

@test "a build that fails shows its last lines, the remedy and the log" {
  program dpkg-query 'echo install ok installed'
  program cmake '[ "$1" = --build ] || exit 0' 'echo "[12/314] Building CXX object x.o"' 'echo "c++: fatal error: Killed signal terminated program cc1plus"' 'exit 1'
  ends 3 'CMAKE_BUILD_PARALLEL_LEVEL=1' env GONIOCHROME_BUILD_FOLDER="$PWD/my builds" "$scripts/demo"
  [[ "$stderr" == *'[12/314] Building CXX object x.o'*"$PWD/my builds/demo/log.txt)"* ]]
  [[ "$output" == *'build three tools (minutes)'*failed* ]]
}

@test "the demo takes tools from PATH, shows the first picture early, and lists what it leaves" {
  tools
  # A checkout that is reached by a link, a working folder elsewhere, and a CDPATH that leads astray.
  ln -s "$(dirname "$scripts")" 'ein Ort für Lacke'
  CDPATH=/ run --separate-stderr 'ein Ort für Lacke/scripts/demo' --wheel 'Bilder für mich'
  echo "$output" "$stderr"
  [ "$status" -eq 0 ]
  [ -z "$stderr" ]
  [ "${#lines[@]}" -le 40 ]
  [ "$(grep -vF "$PWD" <<<"$output" | wc -L)" -le 100 ]
  [[ "${lines[2]}" == *'first picture'*'Bilder für mich/first.png, '*' s after the start' ]]
  [ "$(grep -c 'dE00 mean 0.50, 95 % below 1.25' <<<"$output")" -eq 8 ]
  [ "$(grep -o 'src="data:image/png;base64' 'Bilder für mich/sheet.html' | wc -l)" -eq 8 ]
  # Each file that is there is in the list, under its name or by its ending.
  for file in 'Bilder für mich'/*; do
    file=$(basename "$file")
    case $file in *-*.png | *-*.json) continue ;; handoff*) file=handoff.csv ;; esac
    grep -qF "$file" <<<"$output" || { echo "not in the list: $file"; return 1; }
  done
}

@test "a tool that fails ends the demo with its message" {
  tools
  program prefilter-envmap 'echo "prefilter-envmap: studio.exr: is damaged" >&2; exit 3'
  ends 3 'demo: prefilter studio: prefilter-envmap: studio.exr: is damaged' "$scripts/demo" --wheel out
  # Without the page of the studio, the rest is made.
  tools
  program paint-studio 'echo "paint-studio: there is no page" >&2; exit 3'
  run --separate-stderr "$scripts/demo" --wheel out
  [ "$status" -eq 0 ]
  [[ "$output" == *'write the studio page'*'no page: the end of this stage in log.txt says why'* ]]
  [[ "$output" != *'studio.html'* ]]
}

@test "a picture that is farther from the truth than its tolerance says so behind its error" {
  tools
  sed -i '/--report)/s/;;/; checked=1 ;;/; $a exit ${checked:-0}' bin/render-osmesa
  run --separate-stderr "$scripts/demo" --wheel out
  [ "$status" -eq 0 ]
  [ "$(grep -cE '95 % below 1.25, more than [0-9.]+$' <<<"$output")" -eq 8 ]
}

@test "the demo from a wheel" {
  ends 3 'none.whl: there is no such wheel' "$scripts/demo" --wheel none.whl
  ends 3 'the tools are not in PATH: install a wheel by pip' "$scripts/demo" --wheel out
  touch goniochrome.whl
  program python3 'exit 1'
  ends 3 'has no venv: apt install python3-venv' "$scripts/demo" --wheel goniochrome.whl out
  program python3 'mkdir -p venv/bin && { echo "#!/bin/sh"; echo "echo ERROR: $PWD/goniochrome.whl is not a supported wheel on this platform.; exit 1"; } >venv/bin/pip && chmod +x venv/bin/pip'
  ends 3 'takes glibc 2.36 or newer on x86-64; elsewhere build from source' "$scripts/demo" --wheel goniochrome.whl out
}

@test "wrong command lines" {
  ends 2 '--fast is no option' "$scripts/demo" --fast
  ends 2 'two: give one folder' "$scripts/demo" one two
  ends 2 '--target-de00 needs a color difference' "$scripts/demo" --target-de00
  ends 3 'name another folder for the results' "$scripts/demo" --wheel /dev/null/out
  ends 2 'give dev, asan or release' "$scripts/test" --preset
  ends 2 '"fast": give dev, asan or release' "$scripts/test" --preset fast
  ends 2 'give a command: demo, test or wheel' "$scripts/fresh" trixie
  ends 2 'sid is neither a Debian' "$scripts/fresh" sid demo
  ends 2 'test: give one of demo, test, wheel' "$scripts/fresh" demo test
  ends 2 '--at needs a folder' "$scripts/fresh" demo --at
  ends 2 '--at src: give a whole path' "$scripts/fresh" demo --at src
  ends 2 '--at /x/..: give a whole path' "$scripts/fresh" demo --at /x/..
  ends 3 'none.whl: there is no such wheel' "$scripts/fresh" wheel none.whl
  touch goniochrome.whl
  ends 2 'a wheel goes with the command wheel' "$scripts/fresh" demo goniochrome.whl
  ends 3 'there is no such folder' env GONIOCHROME_DATA=/none "$scripts/fresh" demo
  program id 'echo 1000'
  ends 3 'take root: run sudo scripts/fresh' "$scripts/fresh" demo
  "$scripts/fresh" --help | grep -q 'bookworm|trixie'
  "$scripts/demo" --help | grep -q 'OUT/venv'
}

@test "a script has the version of the tools, and says where it finds none" {
  export GONIOCHROME_BUILD_FOLDER=$PWD/none
  for script in paint-book batch/paint-batch accuracy-report; do
    ends 3 "its version is that of the tools, of which none is in PATH: add their folder to it" "$scripts/$script" --version
    program fit-paint 'echo fit-paint 1.2.3'
    run "$scripts/$script" --version
    [ "$status, $output" = "0, $(basename "$script") 1.2.3" ]
    rm bin/fit-paint
    ends 2 "" "$scripts/$script" --version=now
  done
}
