# shellcheck shell=bash
# bench, study, charts, animate, fmt, lint, clean. Sourced by ./dev.

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

The water against theory and experiment, and where it stays stable; --quick for minutes, --json FILE writes it down,
--plot FOLDER as well, for ./dev charts FOLDER.
TEXT
    return
  fi
  local preset rest
  take_preset "$@"
  prepare_server "$preset"
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset")" study "${rest[@]}"
}

command_charts() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev charts FOLDER

Draws the charts of the results that `spindrift study --plot FOLDER` wrote, as SVG files beside them (Python, matplotlib).
`./dev charts server/study/plots` draws those of the documents again.
TEXT
    return
  fi
  (($# == 1)) || fail 2 "charts wants one folder; see ./dev charts --help"
  need_packages charts
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  # Debian's matplotlib belongs to Debian's Python, which need not be the first on the PATH.
  local python=/usr/bin/python3
  [[ -x "$python" ]] || python=python3
  exec "$python" "$root/server/study/draw_charts.py" "$1"
}

command_animate() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev animate

Shoots web-client/screenshots/harbor.webp, the animated picture of the README: the page in Chromium, at even steps of simulated
time (minutes without a GPU).
TEXT
    return
  fi
  (($# == 0)) || fail 2 "animate takes nothing; see ./dev animate --help"
  need_packages server driver browser animation
  lock_build
  need_web
  build_server release spindrift
  build_web
  npm_install tests/browser browser
  unlock_build
  local folder=build/animation picture=web-client/screenshots/harbor.webp
  rm -rf "$folder"
  step animate "shooting the pictures" env "SPINDRIFT_BINARY=$(binary_of release)" node tests/browser/animate.mjs "$folder"
  # 67 ms: 4 ticks of 60 per second.
  img2webp -loop 0 -lossy -q 55 -m 4 -d 67 "$folder"/*.png -o "$picture" >build/logs/img2webp.log
  say "the picture: $picture ($(du --human-readable --apparent-size "$picture" | cut -f 1))"
}

# Our C++ sources, committed or new. Without shaders/shared: one of its two compilers reads its blocks as GLSL.
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
usage: ./dev lint [--tidy] [PART…]

Checks the formatting of the C++ sources (format), the shell scripts (shell) and the types of the web client (web), or the
parts named; --tidy adds clang-tidy over the server (minutes). Fails when any of them complains.
TEXT
    return
  fi
  local code=0 part parts=()
  for part in "$@"; do
    case "$part" in
      format | shell | web) parts+=("$part") ;;
      --tidy) ;;
      *) fail 2 "lint does not know '$part'; see ./dev lint --help" ;;
    esac
  done
  ((${#parts[@]} > 0)) || parts=(format shell web)
  [[ " $* " != *" --tidy "* ]] || parts+=(tidy)
  for part in "${parts[@]}"; do "lint_$part" || code=1; done
  return "$code"
}

lint_format() {
  need_packages format
  say "formatting"
  check_format
}

lint_shell() {
  need_packages lint
  say "shell scripts"
  shellcheck --external-sources --check-sourced dev .ci/run .ci/bundle/spindrift docker/healthcheck
}

lint_web() {
  say "web client"
  lock_build
  need_web
  npm_install web-client web
  unlock_build
  npm run --silent --prefix web-client lint
}

lint_tidy() {
  need_packages server driver tidy
  build_server release
  say "clang-tidy"
  # Left out: server/codec/wasm, which web-client/scripts/wasm.mjs compiles for another target.
  git ls-files -z -- 'server/*.cpp' ':!server/codec/wasm' | xargs -0 --no-run-if-empty --max-args=4 --max-procs="$(nproc)" \
    clang-tidy --quiet -p build/release
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
