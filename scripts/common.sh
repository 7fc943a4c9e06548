# What the scripts beside it share: it installs the packages that the build needs, and builds. Source it.
# It runs on plain Debian 12. Only if a package is missing, it has to be run by root or by a user with sudo.

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

build_packages=(
  g++ cmake ninja-build ccache pkg-config
  libcgal-dev libceres-dev libcli11-dev libegl-dev libeigen3-dev libembree-dev libfmt-dev libhwy-dev libimath-dev libjpeg-dev liblcms2-dev
  libopencolorio-dev libopenexr-dev libosmesa6-dev libpng-dev libtbb-dev libtiff-dev libtinygltf-dev libxml2-dev libzip-dev nlohmann-json3-dev
  zlib1g-dev
)
test_packages=(
  bats coinor-libclp-dev file jq libegl1 libegl-mesa0 libgl1-mesa-dri librsvg2-bin libbenchmark-dev libgmock-dev libgtest-dev libxml2-utils locales make mandoc
  openexr openimageio-tools procps pybind11-dev python3 python3-dev python3-numpy python3-openimageio strace time
)
# The compiler for the page of paint-studio. Not every system has it, and everything else is built without.
studio_packages=(clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32)
# What scripts/make-wheel needs beside these.
wheel_packages=(binutils coinor-libclp-dev python3-dev python3-venv)
demo_packages=(fonts-dejavu-core openimageio-tools python3)

say() { printf '%s\n' "$*" >&2; }

die() {
  say "$(basename "$0"): $*"
  exit 3
}

# install PACKAGE...: installs those of the packages that are missing, and names them.
install() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  command -v apt-get >/dev/null || die "these Debian packages are missing: ${missing[*]}"
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "installing ${missing[*]} takes root: run as root, or install sudo"
    root=(sudo)
  fi
  say "installing ${#missing[@]} packages: ${missing[*]}"
  "${root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# install_studio: installs the compiler for the page of paint-studio where the system offers it, and says so where not.
install_studio() {
  local package
  for package in "${studio_packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' && continue
    (install "${studio_packages[@]}") 2>/dev/null || say "paint-studio makes no pages: ${studio_packages[*]} cannot be installed"
    return 0
  done
}

# build PRESET [-DOPTION=VALUE...] [TOOL...]: configures and builds into build/PRESET; without tools, all of them.
build() {
  local preset=$1 log argument options=() tools=()
  shift
  for argument in "$@"; do
    case $argument in
      -D*) options+=("$argument") ;;
      *) tools+=("$argument") ;;
    esac
  done
  log=$(mktemp)
  (cd "$top" && cmake --preset "$preset" "${options[@]}") >"$log" 2>&1 || {
    cat "$log" >&2
    die "configuring failed"
  }
  rm -f "$log"
  cmake --build "$top/build/$preset" ${tools[0]:+--target "${tools[@]}"} >&2 || die "the build failed"
}
