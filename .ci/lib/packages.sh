# shellcheck shell=bash
# Debian packages: names, reasons, installation. Sourced by ./dev.

# Packages whose names Debian 12 and later releases do not share. The default Boost of Debian 12 is older than 1.81.
boost_package=libboost-dev wasm_package=libc++-dev-wasm32
if grep --quiet '^VERSION_CODENAME=bookworm$' /etc/os-release 2>/dev/null; then
  boost_package=libboost1.81-dev wasm_package=libc++-14-dev-wasm32
fi

# group:package …; the text of a group gives the reason.
declare -rA package_groups=(
  [server]="git ca-certificates g++ cmake ninja-build ccache pkg-config python3 python3-glad $boost_package
    libprotobuf-dev protobuf-compiler libspdlog-dev libcli11-dev zlib1g-dev libzstd-dev libpng-dev libqrencode-dev libssl-dev libnats-dev nats-server glslc spirv-tools libegl-dev googletest libbenchmark-dev"
  [driver]="libegl1 libegl-mesa0 libgl1-mesa-dri"
  [zink]="mesa-vulkan-drivers libvulkan1"
  [browser]="chromium"
  [python]="python3-numpy python3-websockets python3-protobuf python3-pytest python3-venv python3-pip python3-setuptools python3-wheel protobuf-compiler g++"
  [format]="clang-format"
  [tidy]="clang-tidy"
  [lint]="shellcheck"
  [fuzz]="clang libclang-rt-dev"
  [bundle]="patchelf binutils"
  [faults]="libfaketime"
  [containers]="buildah debootstrap python3"
  [charts]="python3 python3-matplotlib"
  [video]="ffmpeg"
  [npm]="nodejs npm"
  [wasm]="clang lld $wasm_package"
)
declare -rA package_reasons=(
  [server]="building the server and its tests"
  [driver]="OpenGL without a GPU (Mesa's software rasteriser)"
  [zink]="a second OpenGL without a GPU (zink over lavapipe)"
  [browser]="the test in a real browser"
  [python]="the Python client and its tests"
  [format]="formatting"
  [tidy]="static analysis"
  [lint]="checking shell scripts"
  [fuzz]="fuzzing"
  [bundle]="packing libraries"
  [faults]="setting the clock in the tests of faults"
  [containers]="building the image without a Docker daemon"
  [charts]="drawing charts"
  [video]="the animated picture and the tour"
  [npm]="fetching the web client's libraries and a newer Node"
  [wasm]="compiling the page's reader of frames to WebAssembly"
)

# Runs once per start of ./dev.
lists_are_read=false

# Prints those arguments that are packages which are not installed.
missing_packages() {
  dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null |
    awk -v wanted="$*" '$2 == "installed" { have[$1] = 1 }
      END { count = split(wanted, names, /[ \n]+/); for (i = 1; i <= count; ++i) if (!(names[i] in have)) print names[i] }' || true
}

run_as_root() {
  if ((EUID == 0)); then
    "$@"
  elif command -v sudo >/dev/null; then
    if is_interactive; then sudo -- "$@"; else sudo --non-interactive -- "$@"; fi
  else
    return 127
  fi
}

# need_packages GROUP…: installs the missing packages of the groups and prints which and why. Without a missing package
# apt is not run.
need_packages() {
  local group missing=() found=()
  if ! command -v dpkg-query >/dev/null; then
    say "this is not Debian: trusting that these are installed: $(groups_text "$@")"
    return
  fi
  local all=()
  for group in "$@"; do
    read -r -d '' -a found <<<"${package_groups[$group]}" || true
    all+=("${found[@]}")
  done
  mapfile -t missing < <(missing_packages "${all[@]}")
  ((${#missing[@]} > 0)) || return 0

  for group in "$@"; do
    read -r -d '' -a found <<<"${package_groups[$group]}" || true
    mapfile -t found < <(missing_packages "${found[@]}")
    ((${#found[@]} == 0)) || say "installing for ${package_reasons[$group]}: ${found[*]}"
  done
  ((EUID == 0)) || command -v sudo >/dev/null ||
    fail 1 "not root and no sudo here; as root: apt-get install --no-install-recommends ${missing[*]}"
  "$lists_are_read" || step apt-update "reading the package lists" run_as_root env DEBIAN_FRONTEND=noninteractive apt-get update --quiet
  lists_are_read=true
  step apt-install "installing ${#missing[@]} Debian packages" run_as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --quiet --no-install-recommends "${missing[@]}"
}

groups_text() {
  local group
  for group in "$@"; do printf '%s ' "${package_groups[$group]//$'\n'/ }"; done | tr -s ' '
}
