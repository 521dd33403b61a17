# shellcheck shell=bash
# Builds the server (CMake, Ninja) and the web client (npm, Vite). If everything is up to date, this takes a fraction of
# a second. Sourced by ./dev.

# The built page; the server looks for it relative to its own place in the build tree.
readonly web_dist="web-client/dist"

# build_server PRESET [TARGET…]: configures once, then builds the targets (everything when none is named).
build_server() {
  local preset="$1" targets=()
  shift
  (($# == 0)) || targets=(--target "$@")
  if [[ ! -f "build/$preset/build.ninja" ]]; then
    step "configure-$preset" "configuring build/$preset" cmake --preset "$preset"
  fi
  step "build-$preset" "building the server (build/$preset)" cmake --build "build/$preset" --parallel "$(nproc)" "${targets[@]}"
}

# files_digest PATH…: one hash over the names and contents of the files below the paths.
files_digest() {
  find "$@" -type f -not -path '*/node_modules/*' -not -path '*/client/gen/*' -not -path '*/dist/*' -print0 2>/dev/null |
    LC_ALL=C sort -z | xargs -0 --no-run-if-empty sha256sum | sha256sum | cut -d ' ' -f 1
}

# stamp_is NAME VALUE / write_stamp NAME VALUE: compares and stores the input for which a step last ran.
stamp_is() { [[ -f "build/stamps/$1" && "$(<"build/stamps/$1")" == "$2" ]]; }
write_stamp() {
  mkdir -p build/stamps
  printf '%s\n' "$2" >"build/stamps/$1"
}

# npm_install FOLDER NAME: `npm ci`, only when the lock file or Node changed.
npm_install() {
  local folder="$1" name="$2" digest
  digest="$(files_digest "$folder/package.json" "$folder/package-lock.json" "$folder/.npmrc") $(node --version)"
  if [[ -d "$folder/node_modules" ]] && stamp_is "npm-$name" "$digest"; then return; fi
  step "npm-$name" "fetching the libraries of $folder" npm ci --prefix "$folder" --no-fund --no-audit
  write_stamp "npm-$name" "$digest"
}

# need_web: installs what the web client needs for building, checks and tests.
need_web() {
  need_node
  need_packages wasm
}

# build_web: builds web-client/dist if one of its inputs has changed.
build_web() {
  local digest
  npm_install web-client web
  digest="$(files_digest web-client proto server/bitstream server/core/crc32c_tables.cpp) $(project_version) $(node --version)"
  if [[ -f "$web_dist/index.html" ]] && stamp_is web-dist "$digest"; then return; fi
  step web-build "building the web client ($web_dist)" npm run --prefix web-client build
  write_stamp web-dist "$digest"
}

# binary_of PRESET [PROGRAM]: the built program, spindrift if none is named.
binary_of() { printf '%s/build/%s/bin/%s' "$root" "$1" "${2:-spindrift}"; }

# prepare_program PRESET PROGRAM: installs and builds everything that the program needs, then releases the lock.
prepare_program() {
  need_packages server driver
  lock_build
  build_server "$@"
  unlock_build
}

command_build() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev build [--preset release|debug|asan|tsan] [--server | --web] [--all]

Builds build/<preset>/bin/spindrift and web-client/dist. --server or --web builds only that one;
--all builds the tests as well.
TEXT
    return
  fi
  local preset rest argument only="" targets=(spindrift)
  take_preset "$@"
  for argument in "${rest[@]}"; do
    case "$argument" in
      --server | --web) only="${argument#--}" ;;
      --all) targets=() ;;
      *) fail 2 "build does not know '$argument'; see ./dev build --help" ;;
    esac
  done
  need_packages server driver
  lock_build
  [[ "$only" == web ]] || build_server "$preset" "${targets[@]}"
  if [[ "$only" != server ]]; then
    need_web
    build_web
  fi
  say "built: $([[ "$only" == web ]] || printf '%s ' "build/$preset/bin/spindrift")$([[ "$only" == server ]] || printf '%s' "$web_dist")"
}

command_run() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev run [--preset release|debug|asan|tsan] [OPTIONS OF spindrift serve]

Builds what changed and starts the server with the page of this checkout, for example
  ./dev run --port 9000 --scene server/scenes/NAME.textproto
`build/release/bin/spindrift serve --help` lists the server's options. Ctrl-C ends it.
TEXT
    return
  fi
  local preset rest
  take_preset "$@"
  need_packages server driver
  lock_build
  need_web
  build_server "$preset" spindrift
  build_web
  unlock_build
  # Relative paths in options refer to the folder in which the command was typed.
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset")" serve "${rest[@]}"
}
