# shellcheck shell=bash
# The fuzz targets of tests/fuzz: built separately with clang and sanitizers. Sourced by ./dev.

readonly fuzz_targets=(access client_message cluster forwarded foxglove frame http scene state_files tls)

# build_fuzz: builds the targets as build/fuzz/tests/fuzz_TARGET.
build_fuzz() {
  need_packages server fuzz
  build_server fuzz "${fuzz_targets[@]/#/fuzz_}"
}

# fuzz_one TARGET SECONDS: runs the seeds, then the findings of earlier runs, then new inputs; fails at the first input
# that crashes.
fuzz_one() {
  local target="$1" limit_s="$2" folder=build/fuzz
  mkdir -p "$folder/found/$target" "$folder/crashes"
  say "fuzzing $target for $limit_s s; what is found stays in $folder/found/$target"
  bounded "$((limit_s + 120))" "$folder/tests/fuzz_$target" -max_total_time="$limit_s" -timeout=20 -rss_limit_mb=2048 \
    -max_len=16384 -print_final_stats=1 -seed_inputs=@"$folder/seeds/$target" \
    -artifact_prefix="$folder/crashes/$target-" "$folder/found/$target" ||
    fail 1 "$target broke; the line 'Test unit written to' names the input, and build/fuzz/tests/fuzz_$target FILE repeats it"
}

command_fuzz() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev fuzz [access|client_message|cluster|forwarded|foxglove|frame|http|scene|state_files|tls] [SECONDS]

Builds the fuzz targets with clang and sanitizers and runs one, or each in turn, for SECONDS (60 s each by default).
Inputs that reach new code stay in build/fuzz/found, where the next run begins; a failing input is kept in
build/fuzz/crashes and printed by name. `./dev test fuzz` is the short run with a fixed seed.
TEXT
    return
  fi
  local targets=("${fuzz_targets[@]}") limit_s=60 argument
  for argument in "$@"; do
    if [[ "$argument" =~ ^[1-9][0-9]{0,6}$ ]]; then
      limit_s="$argument"
    elif [[ " ${fuzz_targets[*]} " == *" $argument "* ]]; then
      targets=("$argument")
    else
      fail 2 "fuzz does not know '$argument'; see ./dev fuzz --help"
    fi
  done
  lock_build
  build_fuzz
  unlock_build
  for argument in "${targets[@]}"; do fuzz_one "$argument" "$limit_s"; done
}
