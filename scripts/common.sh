# Functions that the bash scripts beside this file share: packages, builds and messages. Source it.
# Debian 12 and 13 have every package. A user without root needs sudo, and only where a package is missing.

top=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# A checkout that cannot be written is built elsewhere: GONIOCHROME_BUILD_FOLDER names the folder of all builds.
builds=$(realpath -m "${GONIOCHROME_BUILD_FOLDER:-$top/build}")

build_packages=(
  g++ cmake ninja-build ccache pkg-config
  libcgal-dev libceres-dev libcli11-dev libdeflate-dev libdraco-dev libegl-dev libeigen3-dev libembree-dev libfmt-dev libhwy-dev libimath-dev libjpeg-dev liblcms2-dev
  libmeshoptimizer-dev libopencolorio-dev libopenexr-dev libpng-dev libtbb-dev libtiff-dev libtinygltf-dev libxml2-dev libzip-dev mandoc nlohmann-json3-dev
  zlib1g-dev
)
test_packages=(
  bats coinor-libclp-dev file jq libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6 librsvg2-bin libbenchmark-dev libgmock-dev libgtest-dev libxml2-utils locales make
  openexr openimageio-tools procps python3 python3-numpy python3-openimageio strace time
)
# The compiler for the page of paint-studio. Not every system has it, and everything else is built without.
studio_packages=(clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32)
# What scripts/make-wheel needs beside these.
wheel_packages=(binutils coinor-libclp-dev python3-venv)

say() { printf '%s\n' "$*" >&2; }

# die SENTENCE: ends with exit status 3, for bad input and for a system that lacks something.
die() {
  say "$(basename "$0"): $*"
  exit 3
}

# refuse SENTENCE: ends with exit status 2, for a wrong command line.
refuse() {
  say "$(basename "$0"): $*"
  exit 2
}

# make_folder FOLDER REMEDY: makes the folder, or ends with the remedy where it cannot be written.
make_folder() {
  mkdir -p -- "$1" 2>/dev/null && [ -w "$1" ] || die "$1 cannot be written: $2"
}

# make_builds: makes the folder of all builds.
make_builds() {
  make_folder "$builds" "set GONIOCHROME_BUILD_FOLDER to a folder of your own on a disk with some GB"
}

# remedy LOG: one sentence on the failure that the log of a command shows, where it is a common one; else the last line of the log.
remedy() {
  local system missing
  if grep -qiE 'no space left on device|enough free space' "$1"; then
    echo "the disk is full: free a few GB, and run this again"
  elif grep -qE 'Killed signal|out of memory|bad_alloc' "$1"; then
    echo "the memory is full: run this again with CMAKE_BUILD_PARALLEL_LEVEL=1, which goes on from here"
  elif grep -qiE 'could not resolve|failure in name resolution|failure resolving|could not connect|unable to connect|network is unreachable|failed to fetch|no matching distribution|connection (refused|timed out)' "$1"; then
    echo "the packages cannot be fetched: check the network, the mirror and the proxy, and run this again"
  elif missing=$(sed -nE "s/^E: (Unable to locate package |Package '?)([^ ']+)('? has no installation candidate)?$/\2/p" "$1" | xargs) && [ -n "$missing" ]; then
    system=$(. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-}")
    echo "${system:-this system} has no package $missing: use Debian 12 or 13, or a wheel, which needs none (scripts/demo --wheel FILE)"
  elif grep -q 'is not a supported wheel' "$1"; then
    echo "the wheel is not for this system: it takes glibc 2.36 or newer on x86-64; elsewhere build from source (scripts/demo)"
  elif grep -qE 'Could not get lock|is locked by another process' "$1"; then
    echo "another program is installing packages: run this again when it has ended"
  elif [ ! -s "$1" ] && [ "$(df --output=avail -k "$1" | tail -n 1)" -lt 100 ]; then
    echo "the disk of $(dirname "$1") is full: free some space there, or set TMPDIR to another folder"
  else
    sed -n '/[^[:space:]]/h; ${g; p}' "$1"
  fi
}

# make_log: prints the path of a new temporary file.
make_log() {
  mktemp 2>/dev/null || die "${TMPDIR:-/tmp} cannot be written: free some space there, or set TMPDIR to another folder"
}

is_installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }

# install PACKAGE...: installs those of the packages that are missing.
install() {
  local missing=() package root=() log why
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  command -v apt-get >/dev/null ||
    die "this system has no apt-get: use a wheel (scripts/demo --wheel FILE), or install what these packages of Debian hold and build with cmake: ${missing[*]}"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "installing packages takes root: run this as root, or install sudo, or have installed: ${missing[*]}"
    root=(sudo)
  fi
  say "installing ${#missing[@]} packages: ${missing[*]}"
  log=$(make_log)
  if ! { "${root[@]}" env LC_ALL=C apt-get update -qq &&
    "${root[@]}" env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    grep '^E: ' "$log" | tail -n 3 >&2 || true
    why=$(remedy "$log")
    rm -f "$log"
    die "the packages are not installed: $why"
  fi
  rm -f "$log"
}

# install_studio: installs the compiler for the page of paint-studio where the system offers it, and says so where not.
install_studio() {
  local package
  for package in "${studio_packages[@]}"; do
    is_installed "$package" && continue
    (install "${studio_packages[@]}") 2>/dev/null || say "paint-studio makes no pages: ${studio_packages[*]} cannot be installed"
    return 0
  done
}

# build PRESET [-DOPTION=VALUE...] [TOOL...]: configures and builds into $builds/PRESET; without tools, all of them.
build() {
  local preset=$1 log argument options=() tools=()
  shift
  for argument in "$@"; do
    case $argument in
      -D*) options+=("$argument") ;;
      *) tools+=("$argument") ;;
    esac
  done
  make_builds
  log=$(make_log)
  (cd "$top" && cmake --preset "$preset" -B "$builds/$preset" "${options[@]}") >"$log" 2>&1 || {
    cat "$log" >&2
    die "configuring failed: the lines above say why"
  }
  rm -f "$log"
  cmake --build "$builds/$preset" ${tools[0]:+--target "${tools[@]}"} >&2 || {
    [ "$(df --output=avail -k "$builds" | tail -n 1)" -gt 100000 ] || die "the disk is full: free a few GB, and run this again"
    die "the build failed: the lines above say why"
  }
}
