# shellcheck shell=bash
# bench, study, fmt, lint, clean. Sourced by ./dev.

command_bench() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev bench [--preset release|debug|asan|tsan] [OPTIONS OF spindrift bench]

Time per pass and per step at several particle counts, and of the stream's encoder; --json FILE writes them down.
TEXT
    return
  fi
  local preset rest
  take_preset "$@"
  prepare_server "$preset"
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset")" bench "${rest[@]}"
}

command_study() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev study [--preset release|debug|asan|tsan] [OPTIONS OF spindrift study]

The water against theory and experiment, and where it stays stable; --quick for minutes, --json FILE writes it down.
TEXT
    return
  fi
  local preset rest
  take_preset "$@"
  prepare_server "$preset"
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset")" study "${rest[@]}"
}

# The C++ sources of ours, committed or about to be. Not shaders/shared: its blocks are GLSL to one of their two compilers.
list_sources() {
  git ls-files --cached --others --exclude-standard -z -- 'server/*.cpp' 'server/*.h' 'tests/*.cpp' 'tests/*.h' |
    while IFS= read -r -d '' file; do [[ ! -f "$file" ]] || printf '%s\0' "$file"; done
}

command_fmt() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev fmt [--check]

Formats the C++ sources in place; --check changes nothing and fails when a file is not formatted.
TEXT
    return
  fi
  need_packages format
  case "${1:-}" in
    "") list_sources | xargs -0 --no-run-if-empty clang-format -i ;;
    --check) check_format ;;
    *) fail 2 "fmt does not know '$1'; see ./dev fmt --help" ;;
  esac
}

check_format() { list_sources | xargs -0 --no-run-if-empty clang-format --dry-run --Werror; }

command_lint() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev lint [--tidy]

Checks the formatting, the shell scripts and the types of the web client; --tidy adds clang-tidy over the
server (minutes). Fails when any of them complains.
TEXT
    return
  fi
  local code=0 with_tidy=false
  case "${1:-}" in
    "") ;;
    --tidy) with_tidy=true ;;
    *) fail 2 "lint does not know '$1'; see ./dev lint --help" ;;
  esac
  need_packages server driver format lint
  say "formatting"
  check_format || code=1
  say "shell scripts"
  shellcheck --external-sources --check-sourced dev .ci/run .ci/bundle/spindrift docker/healthcheck || code=1
  say "web client"
  lock_build
  need_web
  npm_install web-client web
  npm run --silent --prefix web-client lint || code=1
  if "$with_tidy"; then
    need_packages tidy
    build_server release
    say "clang-tidy"
    # server/codec/wasm is compiled for another machine, by web-client/scripts/wasm.mjs.
    git ls-files -z -- 'server/*.cpp' ':!server/codec/wasm' | xargs -0 --no-run-if-empty --max-args=4 --max-procs="$(nproc)" \
      clang-tidy --quiet -p build/release || code=1
  fi
  return "$code"
}

command_clean() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev clean [--all]

Removes build/ (the fetched Node stays), dist/ and web-client/dist; --all removes the fetched Node and the
npm libraries as well.
TEXT
    return
  fi
  case "${1:-}" in
    "") [[ ! -d build ]] || find build -mindepth 1 -maxdepth 1 -not -name tools -exec rm -rf {} + ;;
    --all) rm -rf build web-client/node_modules tests/browser/node_modules tests/wire/node_modules ;;
    *) fail 2 "clean does not know '$1'; see ./dev clean --help" ;;
  esac
  rm -rf dist "$web_dist" web-client/src/gen
}
