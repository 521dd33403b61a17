# shellcheck shell=bash
# bench, study, charts, fmt, lint, clean. Sourced by ./dev.

command_bench() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev bench [--preset release|debug|asan|tsan] [OPTIONS OF spindrift-bench]

Time per pass and per step at several particle counts, and of the stream's encoder; --json FILE writes them down.
TEXT
    return
  fi
  local preset rest
  take_preset "$@"
  prepare_program "$preset" spindrift-bench
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset" spindrift-bench)" "${rest[@]}"
}

command_study() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev study [--preset release|debug|asan|tsan] [OPTIONS OF spindrift-study]
       ./dev study --update

The water against theory and experiment, and where it stays stable; --quick for minutes, --json FILE writes it down,
--plot FOLDER as well, for ./dev charts FOLDER.
--update measures the trade suite anew (about 20 minutes; an interrupted run continues) and writes everything that is made
of it, with date and commit: numbers and charts in docs/plots, tables in the documents, the errors that the server tells its clients.
TEXT
    return
  fi
  if [[ "${1:-}" == --update ]]; then
    (($# == 1)) || fail 2 "study --update takes no options; see ./dev study --help"
    update_study
    return
  fi
  local preset rest
  take_preset "$@"
  prepare_program "$preset" spindrift-study
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  exec "$(binary_of "$preset" spindrift-study)" "${rest[@]}"
}

# Measures on the software rasteriser, as the tests run: with it the state hashes can be compared everywhere.
update_study() {
  local commit
  git diff --quiet HEAD -- server shaders || fail 2 "study --update: commit the changes below server and shaders first"
  commit="$(git rev-parse --short HEAD)"
  need_packages charts
  prepare_program release spindrift-study
  mkdir -p build/study
  rm -f build/study/trade.json
  # Exit code 1 with results: something missed its bound, which is printed and no reason to keep older figures.
  "$(binary_of release spindrift-study)" --suite trade --device software --plot build/study --journal build/study/trade.journal ||
    [[ -f build/study/trade.json ]] || fail 1 "the study ended early; ./dev study --update continues it"
  python3 tests/study/write_tables.py --take build/study/trade.json "$commit"
  rm build/study/trade.journal
  command_charts "$root/docs/plots"
}

command_charts() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev charts FOLDER

Draws the charts of the results that `spindrift-study --plot FOLDER` wrote, as SVG files beside them (Python, matplotlib).
`./dev charts docs/plots` draws those of the documents again.
TEXT
    return
  fi
  (($# == 1)) || fail 2 "charts wants one folder; see ./dev charts --help"
  need_packages charts
  cd -- "$called_from" || fail 2 "the folder $called_from is gone"
  # Debian's matplotlib belongs to Debian's Python, which need not be the first on the PATH.
  local python=/usr/bin/python3
  [[ -x "$python" ]] || python=python3
  exec "$python" "$root/tests/study/draw_charts.py" "$1"
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
usage: ./dev lint [PART…]
       ./dev lint tidy [--all]

Checks the formatting of the C++ sources (format), the shell scripts (shell), the types of the web client (web) and the
words of code and documents (words), or the parts named. `tidy` runs clang-tidy over the C++ files that differ from the
upstream branch, and prints which; --all: over all of them (as `./dev test tidy`). Fails when any of them complains.
TEXT
    return
  fi
  local code=0 part parts=()
  lint_all=false
  for part in "$@"; do
    case "$part" in
      format | shell | web | words | tidy) parts+=("$part") ;;
      --all) lint_all=true ;;
      *) fail 2 "lint does not know '$part'; see ./dev lint --help" ;;
    esac
  done
  "$lint_all" && [[ " ${parts[*]} " != *" tidy "* ]] && fail 2 "--all is for tidy; see ./dev lint --help"
  ((${#parts[@]} > 0)) || parts=(format shell web words)
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
  shellcheck --external-sources --check-sourced dev .ci/run .ci/bundle/spindrift docker/healthcheck docker/build-with-buildah
}

lint_web() {
  say "web client"
  lock_build
  need_web
  npm_install web-client web
  unlock_build
  npm run --silent --prefix web-client lint
}

lint_words() {
  say "words"
  python3 tests/tools/words.py "$root"
}

lint_tidy() {
  local files=()
  if "$lint_all"; then
    mapfile -t files < <(list_tidy_sources)
  else
    mapfile -t files < <(list_changed_sources)
    ((${#files[@]} > 0)) || { say "clang-tidy: no C++ file differs from $(tidy_base)"; return; }
    say "clang-tidy over what differs from $(tidy_base):"
    printf '  %s\n' "${files[@]}" >&2
  fi
  lock_build
  prepare_tidy
  unlock_build
  python3 tests/tools/tidy.py build/tidy build/reports/lint-tidy.xml "${files[@]}"
}

# Every .cpp file that a build compiles. server/bitstream/wasm is compiled for another machine, by web-client/scripts/wasm.mjs.
list_tidy_sources() { git ls-files -- 'server/*.cpp' 'tests/*.cpp' ':!server/bitstream/wasm'; }

# What a change is compared with: where the branch left its upstream, the last commit without an upstream.
tidy_base() { git merge-base HEAD '@{upstream}' 2>/dev/null || git rev-parse HEAD; }

# included_by HEADER: one .cpp file that includes it, if any.
included_by() {
  local name="${1##*/}" folder="${1%/*}"
  git grep --files-with-matches --fixed-strings -e "${folder##*/}/$name>" -e "${folder##*/}/$name\"" -e "\"$name\"" \
    -- 'server/*.cpp' 'tests/*.cpp' ':!server/bitstream/wasm' | head -n 1 || true
}

# The .cpp files that differ from the base, committed or not, and for a changed header one file that includes it.
list_changed_sources() {
  local path
  { git diff --name-only --diff-filter=d "$(tidy_base)" && git ls-files --others --exclude-standard; } |
    while IFS= read -r path; do
      case "$path" in
        server/bitstream/wasm/*) ;;
        server/*.cpp | tests/*.cpp) printf '%s\n' "$path" ;;
        server/*.h | tests/*.h) included_by "$path" ;;
      esac
    done | sort --unique
}

# prepare_tidy: build/tidy, whose compiler is clang and which compiles each file by itself, with all that must exist before
# a file can be parsed: generated sources and precompiled headers. Nothing else is compiled.
prepare_tidy() {
  local inputs=()
  need_packages server fuzz tidy
  [[ -f build/tidy/build.ninja ]] || step configure-tidy "configuring build/tidy" cmake --preset fuzz -B build/tidy -D CMAKE_UNITY_BUILD=OFF
  mapfile -t inputs < <(ninja -C build/tidy -t targets all | sed -n 's/^\(.*cmake_pch\.hxx\.pch\|cmake_object_order_depends_target_.*\): .*/\1/p')
  build_server tidy "${inputs[@]}"
  mkdir -p build/reports
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
  rm -rf dist "$web_dist" web-client/client/gen web-client/client/dist
}
