// A copy of ./dev in a folder with a space in its name. The tools on the PATH record their calls instead of installing and
// compiling, so tests can check which programs ./dev calls, and in which order.
import { spawnSync } from "node:child_process";
import { chmodSync, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

export const repository = fileURLToPath(new URL("../..", import.meta.url));

const FAKES = {
  // $MISSING: the packages that are not installed until apt-get installed something.
  "dpkg-query": `shift 2
for name in "$@"; do
  case " $(cat "$WORKSHOP/missing" 2>/dev/null) " in *" $name "*) ;; *) echo "$name installed" ;; esac
done`,
  "apt-get": `echo "apt-get $*" >>"$WORKSHOP/calls"
case "$1" in install) : >"$WORKSHOP/missing" ;; esac`,
  sudo: `echo "sudo $1" >>"$WORKSHOP/calls"; shift 2; exec "$@"`,
  cmake: `echo "cmake $*" >>"$WORKSHOP/calls"
case "$1" in
  --preset) mkdir -p "build/$2"; : >"build/$2/build.ninja" ;;
  --build) [ ! -e "$WORKSHOP/broken" ] || { echo "error: something does not compile"; exit 1; }
    mkdir -p "$2/bin"
    printf '#!/bin/sh\\npwd\\nprintf "<%%s>" "$@"\\n' >"$2/bin/spindrift"; chmod +x "$2/bin/spindrift"
    cp "$2/bin/spindrift" "$2/bin/spindrift-bench"; cp "$2/bin/spindrift" "$2/bin/spindrift-study" ;;
esac`,
  npm: `echo "npm $*" >>"$WORKSHOP/calls"
case "$*" in
  "ci --prefix build/tools/node"*) bin=build/tools/node/node_modules/.bin; mkdir -p $bin
    printf '#!/bin/sh\\necho v22.23.3\\n' >$bin/node; cp "$0" $bin/npm; chmod +x $bin/node ;;
  "ci --prefix "*) mkdir -p "$3/node_modules" ;;
  *"web-client build"*) mkdir -p web-client/dist; : >web-client/dist/index.html ;;
esac`,
  node: `cat "$WORKSHOP/node_version"`,
};

export class Workshop {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), "spindrift dev "));
    this.checkout = join(this.folder, "a checkout");
    this.tools = join(this.folder, "tools");
    for (const path of ["dev", ".ci", "CMakeLists.txt", "LICENSE"]) {
      cpSync(join(repository, path), join(this.checkout, path), { recursive: true });
    }
    for (const [path, text] of Object.entries({
      "web-client/package.json": "{}",
      "web-client/package-lock.json": "{}",
      "web-client/src/main.ts": "first",
      "proto/wire.proto": "first",
    })) {
      this.write(path, text);
    }
    mkdirSync(this.tools);
    for (const [name, body] of Object.entries(FAKES)) {
      writeFileSync(join(this.tools, name), `#!/bin/bash\n${body}\n`);
      chmodSync(join(this.tools, name), 0o755);
    }
    this.useNode("v20.19.0");
    this.missing("");
  }

  write(path, text) {
    mkdirSync(join(this.checkout, path, ".."), { recursive: true });
    writeFileSync(join(this.checkout, path), text);
  }

  useNode(version) {
    writeFileSync(join(this.folder, "node_version"), `${version}\n`);
  }

  missing(packages) {
    writeFileSync(join(this.folder, "missing"), packages);
  }

  breakCompiler() {
    writeFileSync(join(this.folder, "broken"), "");
  }

  /** Runs ./dev with the arguments; returns exit code, both streams, and what was called meanwhile. */
  dev(args, { cwd = "/", prefix = [] } = {}) {
    const calls = join(this.folder, "calls");
    rmSync(calls, { force: true });
    const command = [...prefix, join(this.checkout, "dev"), ...args];
    const result = spawnSync(command[0], command.slice(1), {
      cwd,
      encoding: "utf8",
      timeout: 60_000,
      env: { PATH: `${this.tools}:/usr/sbin:/usr/bin:/sbin:/bin`, HOME: this.folder, CI: "true", WORKSHOP: this.folder },
    });
    return {
      code: result.status,
      stdout: result.stdout,
      stderr: result.stderr,
      calls: existsSync(calls) ? readFileSync(calls, "utf8").trim().split("\n") : [],
    };
  }

  remove() {
    rmSync(this.folder, { recursive: true, force: true });
  }
}
