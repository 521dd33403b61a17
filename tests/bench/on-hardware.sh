#!/usr/bin/env bash
# Everything worth knowing about Spindrift on a machine with a GPU, in under ten minutes: the devices, the tests of the device, what a
# step and the codecs cost, whether the water agrees with theory, how many rooms hold real time, which tuning profile is the fastest, and
# what the page draws. BUNDLE is a folder made by `./dev bundle --with-tests`; nothing else is needed but bash, coreutils and python3, and
# for the page node, Chromium and the packages of tests/browser.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: tests/bench/on-hardware.sh BUNDLE [--parts PART[,PART…]] [--device NAME] [--output DIR]

  --parts    of info, tests, hash, step, codec, rooms, study, tune, page (default: all of them, in this order)
  --device   as of `spindrift serve` (default: auto)
  --output   where <date>-<device>.json and .md go (default: tests/bench/results); logs go to its folder logs/
TEXT
}

fail() {
  printf 'on-hardware: %s\n' "$1" >&2
  exit 2
}

bundle="" device=auto output="" parts=info,tests,hash,step,codec,rooms,study,tune,page
while (($# > 0)); do
  case "$1" in
    --help) usage && exit ;;
    --parts | --device | --output)
      (($# > 1)) || fail "$1 wants a value; see --help"
      printf -v "${1#--}" '%s' "$2"
      shift
      ;;
    -*) fail "does not know '$1'; see --help" ;;
    *) bundle="$1" ;;
  esac
  shift
done
[[ -x "$bundle/spindrift" ]] || fail "'$bundle' is not a bundle: it has no program spindrift; make one with ./dev bundle --with-tests"
bundle="$(realpath -- "$bundle")"
output="$(realpath -- "${output:-$(dirname -- "${BASH_SOURCE[0]}")/results}")"
logs="$output/logs"
rm -rf "$logs"
mkdir -p "$logs"
checkout="$(realpath -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")"
# What is measured has the profile of the device's class, whatever an earlier `tune` wrote.
printf '{}\n' >"$logs/no-tuning"
export bundle logs checkout SPINDRIFT_TEST_DEVICE="$device" SPINDRIFT_TUNING="$logs/no-tuning"

# These tests read the source tree, so they run only where the checkout is the one that built them.
export without_checkout='ShaderFolderTest.*:LiveShader.*:SharedBlocks.*:*StateBuffersOf*:SavedState*'
readonly part_limit_s=185 all_limit_s=590

# run_suite PROGRAM SUITE: one suite in a process of its own, with a line of its result.
run_suite() {
  local log="$logs/test-$1-${2//[\/.]/_}.log" state=passed
  timeout 120 "$bundle/$1" --gtest_filter="$2*-$without_checkout" >"$log" 2>&1 || state="FAILED ($?)"
  printf '%s %s %s: %s passed, %s failed, %s skipped\n' "$state" "$1" "$2" "$(grep -c '^\[       OK' "$log")" \
    "$(grep -c '^\[  FAILED  \].* ms)$' "$log")" "$(grep -c '^\[  SKIPPED \].* ms)$' "$log")"
}
export -f run_suite

part_info() {
  ! command -v nvidia-smi >/dev/null || nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm --format=csv
  grep -m 1 'model name' /proc/cpuinfo
  nproc
  "$bundle/spindrift" info
  "$bundle/spindrift" info --json "$logs/info.json" >/dev/null
}

# Suites of the device side by side; whole programs that run long, test by test.
part_tests() {
  local program suite
  [[ -x "$bundle/bin/gpu_test" ]] || fail "the bundle has no tests: make it with ./dev bundle --with-tests"
  # shellcheck disable=SC2016  # the inner shell expands them
  for program in gpu_test sim_test endurance_test storm_test sweeps_test; do
    "$bundle/$program" --gtest_list_tests 2>/dev/null | awk '/^[^ ].*\.( |$)/ { print $1 }' |
      while read -r suite; do printf '%s %s\n' "$program" "$suite"; done
  done | xargs -P "$(nproc)" -L 1 bash -c 'run_suite "$1" "$2"' - | sort | tee "$logs/tests.txt"
}

# The same scene twice, and with another order of the work groups: the states must be equal bit for bit. Where they are not,
# the scene runs two times side by side, which names the first buffers that differ. Its own test asks for fewer ticks.
part_hash() {
  local scene file checks hashes equal=true ticks="${SPINDRIFT_HASH_TICKS:-200}"
  for scene in pool splash harbor flotsam; do
    file="$bundle/share/spindrift/scenes/$scene.textproto"
    hashes="$(for checks in "" "" shuffle=7; do SPINDRIFT_GPU_CHECKS="$checks" "$bundle/state_hash" "$file" "$ticks" 2>/dev/null; done)"
    printf '%s %s\n' "$scene" "$(tr '\n' ' ' <<<"$hashes")"
    [[ "$(sort -u <<<"$hashes" | wc -l)" != 1 ]] || continue
    equal=false
    "$bundle/state_hash" "$file" "$ticks" twice 2>/dev/null | sed 's/^/  /' || true
  done
  "$equal"
}

part_step() {
  local scene
  for scene in harbor splash pool flotsam; do
    "$bundle/spindrift-bench" --suite step --scene "$scene" --seconds 1 --device "$device" --json "$logs/step-$scene.json" 2>&1
    printf 'by shader, all cases together:\n'
    SPINDRIFT_GPU_CHECKS=times "$bundle/spindrift-bench" --suite step --scene "$scene" --seconds 0.2 --device "$device" 2>&1 |
      sed -n 's/^.* info  *\([0-9.]* % [a-z]*\/.*\)/  \1/p' | head -n 12
  done
}

part_codec() {
  "$bundle/spindrift-bench" --suite codec --scene thesis --seconds 1 --device "$device" --json "$logs/codec-thesis.json" 2>&1
}

# Eight rooms in one process, each watched by three clients at full detail; the server's last lines tell what each held.
part_rooms() {
  local rooms=(--scene harbor --room b=harbor --room c=harbor --room d=harbor --room e=pool --room f=pool --room g=splash --room h=splash)
  local name urls=() port=18990 server ready=false
  "$bundle/spindrift" serve --port "$port" --device "$device" "${rooms[@]}" >"$logs/serve.log" 2>&1 &
  server=$!
  for _ in {1..300}; do
    if (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then ready=true && break; fi
    kill -0 "$server" 2>/dev/null || break
    sleep 0.1
  done
  "$ready" || { tail -n 20 "$logs/serve.log" && return 1; }
  for name in main b c d e f g h; do urls+=("ws://127.0.0.1:$port/ws/$name"); done
  "$bundle/spindrift-bench" --suite load --url "${urls[@]}" --clients 24 --level full --seconds 8 --json "$logs/rooms.json" 2>&1
  kill -INT "$server"
  wait "$server" || true
  grep -E 'ready|warning|error|real-time factor|sent' "$logs/serve.log" | cut -c 1-200
}

part_study() { "$bundle/spindrift-study" --quick --device "$device" --json "$logs/study.json" 2>&1; }

part_tune() { "$bundle/spindrift-bench" --suite tune --device "$device" --json "$logs/tune.json" 2>&1; }

# With software WebGL, from the page of the bundle.
part_page() {
  local need
  for need in "$(command -v node || printf 'node')" "${CHROMIUM:-/usr/bin/chromium}" "$checkout/tests/browser/node_modules/playwright-core"; do
    [[ -e "$need" ]] || { printf 'skipped: %s is missing\n' "$need" && return; }
  done
  SPINDRIFT_BINARY="$bundle/spindrift" SPINDRIFT_WEB_ROOT="$bundle/share/spindrift/web" \
    node "$checkout/tests/browser/bench_page.mjs" --scenes harbor --seconds 5 2>&1
}

for part in ${parts//,/ }; do
  declare -F "part_$part" >/dev/null || fail "there is no part '$part'; see --help"
done
failed=() cut=()
begin_s=$SECONDS
for part in ${parts//,/ }; do
  printf '\n== %s\n' "$part"
  part_begin_s=$SECONDS code=0
  limit_s=$((all_limit_s - SECONDS + begin_s))
  ((limit_s > 0)) || { printf 'skipped: the ten minutes are over\n' | tee "$logs/$part.log" && cut+=("$part") && continue; }
  export -f "part_$part" fail
  timeout $((limit_s < part_limit_s ? limit_s : part_limit_s)) bash -c "set -euo pipefail; device='$device'; part_$part" 2>&1 | tee "$logs/$part.log" || code=$?
  case $code in
    0) ;;
    124) cut+=("$part") ;;
    *) failed+=("$part") ;;
  esac
  printf '== %s took %d s\n' "$part" $((SECONDS - part_begin_s))
done

python3 - "$logs" "$output" "${failed[*]}" "${cut[*]}" <<'PYTHON'
"""Joins what the parts wrote into one JSON file and one table."""
import datetime, json, os, pathlib, platform, re, sys

logs, output = map(pathlib.Path, sys.argv[1:3])
failed, cut = (text.split() for text in sys.argv[3:])
parts = {file.stem: json.loads(file.read_text()) for file in sorted(logs.glob("*.json"))}
steps = {name[5:]: value["step"] for name, value in parts.items() if name.startswith("step-")}
chosen = parts.get("info", {}).get("chosen", {})
found = {"device": chosen.get("name", "unknown device"), "gl_version": chosen.get("gl_version", "unknown")}
for value in parts.values():
    found.update((key, value[key]) for key in found if isinstance(value.get(key), str))
device, driver = found["device"], found["gl_version"]
tests = (logs / "tests.txt").read_text().splitlines() if (logs / "tests.txt").exists() else []
day = datetime.date.today().isoformat()
name = f"{day}-{re.sub('[^a-z0-9]+', '-', device.lower()).strip('-')[:40]}"

info = (logs / "info.log").read_text() if (logs / "info.log").exists() else ""
processor = "".join(re.findall(r"^model name\s*: (.*)$", info, re.M)[:1]) or platform.machine()
rows = [f"# {device}, {day}", "", f"Driver {driver}; {os.cpu_count()} threads of {processor}, Linux {platform.release()}; "
        f"failed parts: {', '.join(failed) or 'none'}; cut at the end of their time: {', '.join(cut) or 'none'}", ""]
if tests:
    count = lambda what: sum(int(n) for line in tests for n in re.findall(rf"(\d+) {what}", line))
    rows += [f"Tests of the device: {count('passed')} passed, {count('failed')} failed, {count('skipped')} skipped.", ""]
    rows += [f"- {line}" for line in tests if not line.startswith("passed")] + [""]
if steps:
    rows += ["| scene | case | particles | substeps | ms per tick | times real time | ms by pass |", "|---|---|---|---|---|---|---|"]
for scene, cases in steps.items():
    for case in cases:
        passes = " ".join(f"{k} {v:.3f}" for k, v in case["tick_ms_by_pass"].items())
        rows.append(f"| {scene} | {case['name']} | {case['particle_count']} | {case['substeps_count']} | {case['tick_ms']:.3f} "
                    f"| {case['real_time_factor']:.2f} | {passes} |")
for part, pattern in (("hash", r"\S+ [0-9a-f]{16} .*|  tick .*"), ("rooms", r"delay_p99_ms.*|answer_p99_ms.*|.*real-time factor.*"), ("study", r"\d+ within bounds.*"),
                      ("tune", r"\w+ +\d+ +\d+ .*|\{.*|the three minutes.*"), ("page", r".* pictures/s .*|  processor time.*|skipped.*")):
    log = logs / f"{part}.log"
    found = [line for line in (log.read_text().splitlines() if log.exists() else []) if re.fullmatch(pattern, line)]
    rows += ["", f"{part}:", ""] + [f"    {line}" for line in found] if found else []
(output / f"{name}.json").write_text(json.dumps({"date": day, "device": device, "driver": driver, "processor": processor, "failed": failed, "cut": cut, "tests": tests, "parts": parts}, indent=1))
(output / f"{name}.md").write_text("\n".join(rows) + "\n")
print(f"\n{output / name}.json and .md")
PYTHON
((${#failed[@]} == 0)) || { printf 'on-hardware: these parts failed: %s\n' "${failed[*]}" >&2 && exit 1; }
