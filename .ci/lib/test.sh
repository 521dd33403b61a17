# shellcheck shell=bash
# Runs all tests and prints the total. Each part writes a JUnit report; tests/tools/summarise.py adds them up. Sourced
# by ./dev.

# Limits against hanging parts: far above their times on two cores without a GPU.
readonly ctest_limit_s=3600 web_limit_s=600 wire_limit_s=900 browser_limit_s=2700 python_limit_s=1200 tools_limit_s=1800 containers_limit_s=5400 tidy_limit_s=7200

# run_part NAME SECONDS COMMAND…: runs one part, shows and logs its output, and records its exit code. The command
# writes build/reports/NAME.xml.
run_part() {
  local name="$1" limit_s="$2" code=0 shown
  shift 2
  say "== $name"
  rm -f "build/reports/$name.xml"
  exec 8> >(exec tee "build/logs/test-$name.log" >&2)
  shown=$!
  bounded "$limit_s" "$@" >&8 2>&1 8>&- || code=$?
  exec 8>&-
  # The total must be the last line, so wait for the part's output to end, but not for a stray process that keeps the
  # pipe open.
  timeout 10 tail --pid="$shown" --follow /dev/null || true
  ((code != 124)) || say "$name took longer than $limit_s s and was ended"
  add_report "$name" "$code"
}

# add_report NAME CODE: remembers a part for the total. Parts run in subshells as well, so in a file.
add_report() { printf '%s\n' "$1:$2:$root/build/reports/$1.xml" >>build/reports/parts; }

# CTest runs tests side by side as far as their weights (PROCESSORS in tests/CMakeLists.txt) fit into three per core. The
# rasteriser computes on the thread that asks: threads of its own would only take turns with those of the other tests.
# Tests of its threads set their number themselves.
# The whole output goes into the report, which names the tests of a suite.
readonly ctest_options=(--parallel "$((3 * $(nproc)))" --output-on-failure --timeout 600
  --test-output-size-passed 10000000 --test-output-size-failed 10000000)
readonly rasteriser_environment=(LP_NUM_THREADS=0)

# test_native NAME PRESET [LABEL]
test_native() {
  local name="$1" filter=()
  [[ -z "${3:-}" ]] || filter=(--label-regex "^$3\$")
  local environment=("${rasteriser_environment[@]}")
  if [[ -n "$test_regex" ]]; then
    filter+=(--tests-regex "$test_regex")
    environment+=(SPINDRIFT_TESTS_APART=1)
  fi
  run_part "$name" "$ctest_limit_s" env "${environment[@]}" ctest --test-dir "build/$2" "${ctest_options[@]}" \
    --output-junit "$root/build/reports/$name.xml" "${filter[@]}"
}

# A second OpenGL without a GPU: Mesa's zink over its Vulkan rasteriser lavapipe. Unlike llvmpipe it is asynchronous:
# fences signal later, readbacks arrive some ticks after the request, and it has a different shader compiler.
readonly zink_environment=(LIBGL_ALWAYS_SOFTWARE=1 MESA_LOADER_DRIVER_OVERRIDE=zink)
# Runs the gpu and sim tests, and the stability tests that compare no times, some of them shorter than in `native`. Left out
# are suites that only compare waves with theory for minutes: nothing in them depends on when the device answers, and the
# other suites compile the same shaders.
readonly zink_tests='^gpu/|^stability/(.*Determinism.*/(pool|splash|harbor)( |$)|Endurance\.(TheLedgerOfSurfaceAndParticlesIsExact|NoParticleStaysBelowTheSurfaceOrInARock|StillPoolStaysStillPositionBased)$)'

readonly zink_leaves_out='^gpu/(Waves/)?(WindSeaOnDevice|MatchedLayerOnDevice|WaveMakersOnDevice|ExtremeMakers|DispersedSlopeOnDevice|BoatMotion)'

# Prints nothing if the program can use zink, otherwise the reason in one line.
zink_problem() {
  local info
  info="$(env "${zink_environment[@]}" "$(binary_of "$preset")" info 2>&1)" || true
  grep -q '^auto .*zink' <<<"$info" || printf 'zink does not start here: %s' "$(grep '^auto' <<<"$info" || tail -n 1 <<<"$info")"
}

test_zink() {
  local problem
  problem="$(zink_problem)"
  if [[ -n "$problem" ]]; then
    write_skipped "$root/build/reports/zink.xml" "every test on zink" "$problem"
    add_report zink 0
    return
  fi
  run_part zink "$ctest_limit_s" env "${rasteriser_environment[@]}" "${zink_environment[@]}" \
    SPINDRIFT_LEDGER_TICKS=300 SPINDRIFT_STILL_TICKS=300 \
    ctest --test-dir "build/$preset" "${ctest_options[@]}" --tests-regex "$zink_tests" --exclude-regex "$zink_leaves_out" \
    --output-junit "$root/build/reports/zink.xml"
}

# The programs of the part `memory`: unit tests that need no device, under clang's address and undefined-behaviour
# sanitizers, in the tree of the fuzz targets, whose libraries are built with them already. Tests on a device stay out: the
# shaders that the rasteriser compiles are not instrumented, and it is slow under the sanitizers. Without a named part only
# those with the label memory run: clang takes minutes for the files of net and gpu.
readonly memory_programs_when_named=(net_test water_test history_test rooms_test service_test gpu_text_test)

# write_skipped FILE NAME REASON: writes a report of one skipped test and prints the reason.
write_skipped() {
  say "skipped: $3"
  python3 - "$@" <<'PYTHON'
import sys, xml.etree.ElementTree as tree
path, name, reason = sys.argv[1:]
suite = tree.Element("testsuite", tests="1", skipped="1")
case = tree.SubElement(suite, "testcase", name=name)
tree.SubElement(case, "skipped", message=reason)
tree.ElementTree(suite).write(path)
PYTHON
}

test_web() {
  run_part web "$web_limit_s" npm run --silent --prefix web-client test -- \
    --reporter=default --reporter=junit "--outputFile.junit=$root/build/reports/web.xml"
}

# Tests the npm package ws with the messages of the web client, and the packed JavaScript client, in the web client's Vitest.
test_wire() {
  run_part wire "$wire_limit_s" env "SPINDRIFT_BINARY=$(binary_of "$preset")" node web-client/node_modules/vitest/vitest.mjs run \
    --root tests/wire --reporter=default --reporter=junit "--outputFile.junit=$root/build/reports/wire.xml"
}

# Installs the Python client as a user would, into a virtual environment with Debian's numpy, websockets and protobuf, and runs its tests.
test_python() {
  local venv="$root/build/python"
  [[ -x "$venv/bin/python" ]] || /usr/bin/python3 -m venv --system-site-packages "$venv"
  step python-client "installing the Python client into build/python" "$venv/bin/python" -m pip install --quiet --no-deps --no-build-isolation \
    --force-reinstall ./python-client
  run_part python "$python_limit_s" env "SPINDRIFT_BINARY=$(binary_of "$preset")" "$venv/bin/python" -m pytest --quiet -p no:cacheprovider \
    "--junitxml=$root/build/reports/python.xml" python-client/tests
}

test_tidy() {
  local files=()
  mapfile -t files < <(list_tidy_sources)
  run_part tidy "$tidy_limit_s" python3 tests/tools/tidy.py build/tidy "$root/build/reports/tidy.xml" "${files[@]}"
}

# Files of browser tests at the same time: a browser waits for its server and its pages for a third of the time.
readonly browsers=2

# node_tests NAME SECONDS FILES_AT_ONCE FILE…
node_tests() {
  local name="$1" limit_s="$2" at_once="$3"
  shift 3
  run_part "$name" "$limit_s" env "SPINDRIFT_BINARY=$(binary_of "$preset")" node --test --test-concurrency="$at_once" \
    --test-reporter=spec --test-reporter-destination=stdout \
    --test-reporter=junit "--test-reporter-destination=$root/build/reports/$name.xml" "$@"
}

# Builds the image and runs it: about ten minutes, so only when the part is named. image.test.mjs skips itself with the reason
# where it cannot run.
test_containers() {
  if ! "$containers_when_named"; then
    write_skipped "$root/build/reports/containers.xml" "the image builds and runs" "the image takes about ten minutes: ./dev test containers"
    add_report containers 0
    return
  fi
  node_tests containers "$containers_limit_s" 1 tests/containers/image.test.mjs
}

beside=""  # process of the parts that run beside the others

command_test() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev test [--preset release|debug|asan|tsan] [PART…] [-R REGEX]

Builds everything and runs every test, or the parts named: unit, integration, accuracy, stability, gpu (C++),
native (all of those), zink (gpu, sim and stability tests on Mesa's second, asynchronous OpenGL), web (the client's
own tests), wire (the npm package ws and the JavaScript client against the real server), python (the Python client against it), browser (the page in Chromium against it), tools
(./dev itself, formatting and types, the bundle, the documents, Compose and Kubernetes files), fuzz (parsers and decoders under hostile input, some
seconds each), memory (unit tests under the address and undefined-behaviour sanitizers: those with MEMORY in tests/unit, or
all of them when the part is named), threads (network, encoder, access and files of the state under the thread sanitizer).
The last three have presets of their own.
Only when named, otherwise skipped: containers (builds the image with buildah, as root, and runs it; about ten minutes).
Only when named: tidy (clang-tidy over every C++ file, a test per file).
-R runs only the C++ tests whose names match, for example `./dev test unit -R Outbox`, and builds only their programs.
The last line is `N passed, N failed, N skipped`; exit code 1 when anything failed. Reports: build/reports/*.xml, logs:
build/logs.
TEXT
    return
  fi
  local preset rest part parts=() test_regex=""
  take_preset "$@"
  while ((${#rest[@]} > 0)); do
    case "${rest[0]}" in
      -R) ((${#rest[@]} > 1)) || fail 2 "-R needs a regular expression; see ./dev test --help"
        test_regex="${rest[1]}"
        rest=("${rest[@]:2}") ;;
      *) parts+=("${rest[0]}")
        rest=("${rest[@]:1}") ;;
    esac
  done
  [[ -z "$test_regex" ]] || ((${#parts[@]} > 0)) || parts=(native)
  local memory_label=unit containers_when_named=true
  if ((${#parts[@]} == 0)); then
    parts=(native zink web wire python browser tools fuzz memory threads containers)
    memory_label=memory
    containers_when_named=false
  fi
  for part in "${parts[@]}"; do
    case "$part" in
      native | unit | integration | accuracy | stability | gpu | zink | web | wire | python | browser | tools | fuzz | memory | threads | containers | tidy) ;;
      *) fail 2 "there is no test part '$part'; see ./dev test --help" ;;
    esac
  done

  # If anything stops the script from here on, the last line is a total with a failure.
  trap '[[ -z "$beside" ]] || kill "$beside" 2>/dev/null; echo "0 passed, 1 failed, 0 skipped"' EXIT
  prepare_tests "${parts[@]}"
  : >build/reports/parts
  # Parts that mostly wait run one after the other beside the first of the others, which computes; their output is shown after its own.
  local waiting=() computing=()
  for part in "${parts[@]}"; do
    if [[ "$part" == @(web|wire|python|tools) ]]; then waiting+=("$part"); else computing+=("$part"); fi
  done
  if ((${#computing[@]} == 0)); then
    run_parts "${waiting[@]}"
  else
    run_parts "${waiting[@]}" 2>build/logs/beside.log &
    beside=$!
    run_parts "${computing[0]}"
    local code=0
    wait "$beside" || code=$?
    beside=""
    cat build/logs/beside.log >&2
    ((code == 0)) || fail 1 "one of the parts ${waiting[*]} could not run"
    run_parts "${computing[@]:1}"
  fi
  trap - EXIT
  mapfile -t parts <build/reports/parts
  python3 tests/tools/summarise.py "${parts[@]}"
}

# run_parts PART…: runs them one after the other.
run_parts() {
  local part
  for part in "$@"; do
    case "$part" in
      native) test_native native "$preset" ;;
      zink) test_zink ;;
      fuzz) test_native fuzz fuzz fuzz ;;
      memory) test_native memory fuzz "$memory_label" ;;
      tidy) test_tidy ;;
      threads) test_native threads tsan threads ;;
      web) test_web ;;
      wire) test_wire ;;
      python) test_python ;;
      browser) node_tests browser "$browser_limit_s" "$browsers" tests/browser/*.test.mjs ;;
      tools) node_tests tools "$tools_limit_s" 1 tests/tools/*.test.mjs tests/containers/deployment.test.mjs ;;
      containers) test_containers ;;
      *) test_native "$part" "$preset" "$part" ;;
    esac
  done
}

build_memory_tests() {
  need_packages server fuzz
  local programs=(memory_tests)
  [[ "$memory_label" == memory ]] || programs+=("${memory_programs_when_named[@]}")
  build_server fuzz "${programs[@]}"
}

# Installs and builds everything that the parts need.
prepare_tests() {
  local groups=(server driver) wanted=" $* " with_native=false with_node=false
  [[ ! "$wanted" =~ \ (native|integration)\  ]] || groups+=(faults)
  [[ "$wanted" != *" zink "* ]] || groups+=(zink)
  [[ "$wanted" != *" browser "* ]] || groups+=(browser)
  [[ "$wanted" != *" python "* ]] || groups+=(python)
  [[ "$wanted" != *" tools "* ]] || groups+=(bundle format lint)
  # Without root the image cannot be built, and its tests say so.
  [[ "$wanted" != *" containers "* ]] || ! "$containers_when_named" || ((EUID != 0)) || groups+=(containers)
  [[ ! "$wanted" =~ \ (native|unit|integration|accuracy|stability|gpu|zink)\  ]] || with_native=true
  [[ ! "$wanted" =~ \ (web|wire|browser|tools)\  ]] || with_node=true

  need_packages "${groups[@]}"
  lock_build
  mkdir -p build/reports build/logs
  ! "$with_node" || need_web
  [[ "$wanted" != *" containers "* ]] || need_node
  if "$with_native" && [[ -n "$test_regex" ]]; then
    local targets
    targets="$(python3 tests/tools/test_targets.py "$test_regex")" || fail 2 "no C++ test is named like -R '$test_regex'"
    # shellcheck disable=SC2086
    build_server "$preset" $targets
  elif "$with_native"; then
    build_server "$preset"
  elif [[ "$wanted" == *" tools "* ]]; then
    build_server "$preset" "${bundled_programs[@]}"
  elif [[ "$wanted" =~ \ (wire|python|browser)\  ]]; then
    build_server "$preset" spindrift
  fi
  [[ "$wanted" != *" fuzz "* ]] || build_fuzz
  [[ "$wanted" != *" memory "* ]] || build_memory_tests
  [[ "$wanted" != *" tidy "* ]] || prepare_tidy
  [[ "$wanted" != *" threads "* ]] || build_server tsan threads_tests
  [[ "$wanted" != *" web "* ]] || npm_install web-client web
  [[ ! "$wanted" =~ \ (wire|browser|tools)\  ]] || build_web
  [[ "$wanted" != *" browser "* ]] || npm_install tests/browser browser
  [[ "$wanted" != *" wire "* ]] || npm_install tests/wire wire
  [[ ! "$wanted" =~ \ (tools|containers)\  ]] || npm_install tests/containers containers
  unlock_build
}
