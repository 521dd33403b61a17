# shellcheck shell=bash
# Node for the web client and the browser test. Vite needs 20.19 or newer, and Debian 12 has 18: there, Debian's npm
# installs a newer node and npm into build/tools/node (pinned by .ci/node/package-lock.json), for ./dev only. Sourced by
# ./dev.

readonly private_node="build/tools/node"

# node_is_new_enough VERSION ("v20.19.0"): the versions that Vite 8 and Vitest 4 both support.
node_is_new_enough() {
  [[ "$1" =~ ^v([0-9]+)\.([0-9]+)\. ]] || return 1
  local major="${BASH_REMATCH[1]}" minor="${BASH_REMATCH[2]}"
  case "$major" in
    20) ((minor >= 19)) ;;
    22) ((minor >= 12)) ;;
    *) ((major >= 24)) ;;
  esac
}

system_node_is_ready() { command -v npm >/dev/null && node_is_new_enough "$(node --version 2>/dev/null)"; }

# need_node: puts a new enough `node` and `npm` on the PATH: those of the system, installed first if there are none, or
# where they are too old, newer ones of our own.
need_node() {
  if system_node_is_ready; then return; fi
  if ! private_node_is_ready; then
    command -v npm >/dev/null || need_packages npm
    if system_node_is_ready; then return; fi
    [[ "$(uname -m)" == x86_64 ]] ||
      fail 1 "the web client needs Node 20.19 or newer with npm, and this machine ($(uname -m)) has none: install it and start again"
    say "Node $(node --version 2>/dev/null) is too old for the web client (20.19 or newer)"
    rm -rf "$private_node"
    mkdir -p "$private_node"
    cp .ci/node/package.json .ci/node/package-lock.json .ci/node/.npmrc "$private_node/"
    step node "fetching a newer Node into $private_node" npm ci --prefix "$private_node" --ignore-scripts
    cp .ci/node/package-lock.json "$private_node/complete"
  fi
  PATH="$root/$private_node/node_modules/.bin:$PATH"
  export PATH
  hash -r
  node_is_new_enough "$(node --version)" || fail 1 "the fetched Node says '$(node --version)', which is too old: remove $private_node and start again"
}

private_node_is_ready() { cmp --silent .ci/node/package-lock.json "$private_node/complete"; }
