# shellcheck shell=bash
# Messages, quiet steps with a log, and the options that several commands share. Sourced by ./dev.

# Progress goes to standard error; standard output is for results (the address, the totals).
say() { printf '%s\n' "$*" >&2; }

# fail CODE MESSAGE: prints one line and exits.
fail() {
  local code="$1"
  shift
  printf 'dev: %s\n' "$*" >&2
  exit "$code"
}

# True on a terminal; a build machine gets neither colours nor progress lines.
is_interactive() { [[ -t 2 && "${CI:-}" != true && "${TERM:-dumb}" != dumb ]]; }

# Settings for tools that print colours by themselves.
is_interactive || export NO_COLOR=1 CMAKE_COLOR_DIAGNOSTICS=OFF

# step NAME TEXT COMMAND…: runs a command. On a terminal its output is shown; otherwise it goes to a log, whose end is
# shown on failure.
step() {
  local name="$1" text="$2" log="build/logs/$1.log" started="$SECONDS" code=0
  shift 2
  say "$text"
  if is_interactive; then
    "$@" >&2 || code=$?
  else
    mkdir -p build/logs
    "$@" >"$log" 2>&1 || code=$?
    ((code == 0)) || { tail -n 60 "$log" >&2 && say "the whole log: $log"; }
  fi
  ((code == 0)) || fail 1 "step '$name' failed with exit code $code after $((SECONDS - started)) s"
  ((SECONDS - started < 2)) || say "  done in $((SECONDS - started)) s"
}

# bounded SECONDS COMMAND…: ends the command and its children if it takes longer (exit code 124) or if ./dev is
# interrupted.
bounded() {
  local limit_s="$1" child code=0
  shift
  timeout --kill-after=15 "$limit_s" "$@" &
  child=$!
  # shellcheck disable=SC2064  # the id of this child, now
  trap "kill -TERM $child 2>/dev/null; wait $child; exit 130" INT TERM
  wait "$child" || code=$?
  trap - INT TERM
  return "$code"
}

# Only one ./dev per checkout runs at a time; the lock is held until this shell ends or unlocks.
lock_build() {
  mkdir -p build
  exec 9>build/.dev-lock
  flock --nonblock 9 && return
  say "another ./dev works in this checkout; waiting for it"
  flock 9
}

unlock_build() { exec 9>&-; }

# take_preset "$@": sets `preset` and leaves all other arguments, in order, in `rest`.
take_preset() {
  preset=release
  rest=()
  while (($# > 0)); do
    case "$1" in
      --preset)
        (($# > 1)) || fail 2 "--preset wants a value: release, debug, asan or tsan"
        preset="$2"
        shift
        ;;
      --preset=*) preset="${1#--preset=}" ;;
      *) rest+=("$1") ;;
    esac
    shift
  done
  case "$preset" in
    release | debug | asan | tsan) ;;
    *) fail 2 "unknown preset '$preset'; there are release, debug, asan and tsan" ;;
  esac
}

wants_help() {
  [[ "${1:-}" == --help || "${1:-}" == -h ]]
}

project_version() { sed -n 's/^project(spindrift VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt; }
