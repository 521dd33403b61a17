# shellcheck shell=bash
# Packs a folder that runs on another x86-64 Linux: program, page, scenes, the libraries they need, and Mesa's software
# rasteriser for machines without a driver. Sourced by ./dev; the launcher is .ci/bundle/spindrift.
#
# The programs in bin/ find lib/ by their RUNPATH. Libraries that drivers of the machine use, too, are in
# lib/fallback/NAME/ and are used only if the machine has none, because a newer driver must not load an older library;
# OpenSSL as well, because the machine's own gets security updates. Mesa's libraries find each other by RUNPATH, and no
# other program sees them.

# The C library is not bundled; it is the machine's.
readonly glibc_libraries='^(ld-linux-.*|lib(c|m|mvec|dl|pthread|rt|resolv|util|anl|nsl)\.so\..*|libnss_.*|linux-vdso\.so.*)$'
readonly shared_with_drivers='^(libstdc\+\+\.so\.6|libgcc_s\.so\.1|libz\.so\.1|libssl\.so\.3|libcrypto\.so\.3|libEGL\.so\.1|libGLdispatch\.so\.0)$'

# library_closure FILE…: prints "NAME PATH" of every shared library that the files need, directly or indirectly, except
# the C library.
library_closure() {
  local lines
  lines="$(ldd "$@")"
  if [[ "$lines" == *"not found"* ]]; then
    fail 1 "libraries are missing on this machine: $(grep 'not found' <<<"$lines" | tr -s '\t\n ' ' ')"
  fi
  awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' <<<"$lines" | sort -u |
    while read -r name path; do [[ "$name" =~ $glibc_libraries ]] || printf '%s %s\n' "$name" "$path"; done
}

# The server, and what measures it on the machine to which the bundle goes. With --with-tests, also the tests of the device.
readonly bundled_programs=(spindrift spindrift-bench spindrift-study)
readonly bundled_tests=(gpu_test sim_test endurance_test storm_test sweeps_test state_hash)

# copy_library PATH TARGET: copies the file behind the links, under the name that programs use, and records it for the
# licences.
copy_library() {
  local path="$1" target="$2"
  install -D --mode=755 "$(readlink -f -- "$path")" "$target"
  bundled_files+=("$path")
}

# bundle_program FOLDER PROGRAM…
bundle_program() {
  local folder="$1" name path real built=("${@:2}")
  for path in "${built[@]}"; do
    name="$(basename -- "$path")"
    install -D --mode=755 "$path" "$folder/bin/$name"
    strip --strip-debug "$folder/bin/$name"
    [[ "$name" == spindrift ]] || ln -s spindrift "$folder/$name"
  done
  while read -r name path; do
    if [[ "$name" =~ $shared_with_drivers ]]; then
      # The launcher compares versions by the file's real name.
      real="$(basename -- "$(readlink -f -- "$path")")"
      copy_library "$path" "$folder/lib/fallback/$name/$real"
      [[ "$real" == "$name" ]] || ln -s "$real" "$folder/lib/fallback/$name/$name"
    else
      copy_library "$path" "$folder/lib/$name"
      # shellcheck disable=SC2016  # $ORIGIN is for the loader
      patchelf --set-rpath '$ORIGIN' "$folder/lib/$name"
    fi
  done < <(library_closure "${built[@]}")
  # shellcheck disable=SC2016
  patchelf --set-rpath '$ORIGIN/../lib' "$folder"/bin/*
}

# shellcheck disable=SC2016  # $ORIGIN is for the loader
bundle_mesa() {
  local folder="$1" vendor driver name path
  vendor="$(/sbin/ldconfig -p | sed -n 's/^[[:space:]]*libEGL_mesa\.so\.0 (.*x86-64.*) => //p' | head -n 1)"
  driver="$(dirname -- "${vendor:-/}")/dri/swrast_dri.so"
  [[ -e "$driver" ]] || fail 1 "Mesa's driver $driver is not there: this bundle is made on Debian 12 (or use --without-mesa)"
  while read -r name path; do
    [[ ! "$name" =~ $shared_with_drivers ]] || {
      [[ -e "$folder/lib/fallback/$name" ]] || copy_library "$path" "$folder/lib/fallback/$name/$name"
      continue
    }
    copy_library "$path" "$folder/lib/mesa/$name"
    patchelf --set-rpath '$ORIGIN' "$folder/lib/mesa/$name"
  done < <(library_closure "$vendor" "$driver")
  copy_library "$vendor" "$folder/lib/mesa/vendor/libEGL_mesa.so.0"
  copy_library "$driver" "$folder/lib/mesa/dri/swrast_dri.so"
  patchelf --set-rpath '$ORIGIN/..' "$folder/lib/mesa/vendor/libEGL_mesa.so.0"
  patchelf --set-rpath '$ORIGIN/..' "$folder/lib/mesa/dri/swrast_dri.so"
  mkdir -p "$folder/share/glvnd/egl_vendor.d"
  printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_mesa.so.0"}}\n' \
    >"$folder/share/glvnd/egl_vendor.d/60_spindrift_mesa.json"
}

# bundle_licences FOLDER PRESET VERSION: writes what the bundle consists of (share/sbom.cdx.json), and the licence of each part.
bundle_licences() {
  mkdir -p "$1/share/licenses"
  python3 .ci/lib/sbom.py bundle --version "$3" --build-dir "build/$2" --web-client web-client --licences "$1/share/licenses" \
    "${bundled_files[@]}" >"$1/share/sbom.cdx.json" || fail 1 "the list of the bundle's parts could not be written"
}

bundle_readme() {
  local folder="$1" version="$2" mesa="$3" text system glibc
  system="$(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' /etc/os-release)"
  glibc="$(ldd --version | sed -n '1s/.* \([0-9.]*\)$/\1/p')"
  if "$mesa"; then
    text="Mesa's software rasteriser from \`lib/mesa\` is used where the machine has no Mesa of its own."
  else
    text="the machine's own Mesa is used (Debian: libegl1 and libgl1-mesa-dri); this bundle was made without."
  fi
  sed -e "s|@VERSION@|$version|" -e "s|@GLIBC@|$glibc|" -e "s|@SYSTEM@|$system|" -e "s|@MESA@|$text|" \
    .ci/bundle/README.md >"$folder/README.md"
}

command_bundle() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev bundle [--output DIR] [--without-mesa] [--with-tests] [--no-archive] [--preset release|debug]

Packs dist/spindrift-<version>-linux-x86_64/ and the same as .tar.gz: program, page, scenes, every library but the
C library's, and Mesa's software rasteriser for machines without a driver. It runs on another x86-64 Linux with
nothing installed but (for speed) a GPU driver. --with-tests adds the tests of the device, for tests/bench/on-hardware.sh.
TEXT
    return
  fi
  local preset rest output=dist mesa=true tests=() archive=true version name folder bundled_files=()
  take_preset "$@"
  set -- "${rest[@]}"
  while (($# > 0)); do
    case "$1" in
      --output)
        (($# > 1)) || fail 2 "--output wants a folder"
        output="$(cd -- "$called_from" && realpath --canonicalize-missing -- "$2")"
        shift
        ;;
      --without-mesa) mesa=false ;;
      --with-tests) tests=("${bundled_tests[@]}") ;;
      --no-archive) archive=false ;;
      *) fail 2 "bundle does not know '$1'; see ./dev bundle --help" ;;
    esac
    shift
  done
  need_packages server driver bundle
  lock_build
  need_web
  build_server "$preset" "${bundled_programs[@]}" "${tests[@]}"
  build_web
  unlock_build

  version="$(project_version)"
  name="spindrift-$version-linux-x86_64"
  folder="$output/$name"
  say "packing $folder"
  rm -rf "$folder" "$folder.tar.gz"
  mkdir -p "$folder/share/spindrift"
  bundle_program "$folder" "${bundled_programs[@]/#/$root/build/$preset/bin/}" "${tests[@]/#/$root/build/$preset/tests/}"
  ! "$mesa" || bundle_mesa "$folder"
  cp -r server/scenes "$folder/share/spindrift/scenes"
  cp -r "$web_dist" "$folder/share/spindrift/web"
  install --mode=755 .ci/bundle/spindrift "$folder/spindrift"
  install --mode=644 LICENSE "$folder/LICENSE"
  bundle_licences "$folder" "$preset" "$version"
  bundle_readme "$folder" "$version" "$mesa"
  if "$archive"; then
    tar --directory "$output" --sort=name --owner=0 --group=0 --numeric-owner -czf "$folder.tar.gz" "$name"
    say "packed $(du --human-readable --apparent-size "$folder.tar.gz" | cut -f 1) into $folder.tar.gz"
  fi
  say "the bundle: $folder ($(du --human-readable --summarize "$folder" | cut -f 1))"
}
