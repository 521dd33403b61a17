import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { afterEach, beforeEach, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

/** Runs the check over a folder; returns its exit code and its lines without the total. */
function check(folder) {
  const result = spawnSync("python3", [join(repository, "tests/tools/documents.py"), folder], { encoding: "utf8" });
  assert.equal(result.stderr, "");
  return { code: result.status, faults: result.stdout.trimEnd().split("\n").slice(0, -1) };
}

describe("the documents", () => {
  it("have no broken links and name only existing functions and files", () => {
    const { code, faults } = check(repository);
    assert.deepEqual(faults, []);
    assert.equal(code, 0);
  });

  it("list in docs/cli.md every command and option that the programs have, and no other", () => {
    const text = readFileSync(join(repository, "docs/cli.md"), "utf8");
    const help = (args, suffix = "") => {
      const result = spawnSync(process.env.SPINDRIFT_BINARY + suffix, [...args, "--help"], { encoding: "utf8" });
      assert.equal(result.status, 0, `spindrift${suffix} ${args.join(" ")} --help: ${result.error ?? result.stderr}`);
      return result.stdout;
    };
    const optionsOf = (usage) => [...usage.matchAll(/^ {2}(?:-\w,)?(--[a-z-]+)/gm)].map((match) => match[1]).filter((name) => name !== "--help");
    // A row for each option, and for the edge one for all those of `serve`.
    const rowsOf = (section) =>
      [...section.matchAll(/^\| `(--[a-z-]+)|^\| as for `serve` .*/gm)]
        .flatMap(([row, name]) => (name !== undefined ? [name] : [...row.matchAll(/`(--[a-z-]+)`/g)].map((match) => match[1])))
        .filter((name) => name !== "--help");
    const overview = help([]);
    const commands = [...overview.slice(overview.indexOf("Subcommands:")).matchAll(/^ {2}(\w+) /gm)].map((match) => match[1]);
    const sections = new Map(text.split(/^### `spindrift /m).slice(1).map((section) => [section.match(/^\w+/)[0], section.split(/^## /m)[0]]));
    assert.deepEqual([...sections.keys()].sort(), commands.sort());
    for (const command of commands) {
      assert.deepEqual(rowsOf(sections.get(command)).sort(), optionsOf(help([command])).sort(), command);
    }
    const common = text.split("## `spindrift`")[1].split("### ")[0];
    assert.deepEqual(rowsOf(common).sort(), optionsOf(overview).sort());
    for (const suffix of ["-bench", "-study"]) {
      const own = text.split(`## \`spindrift${suffix}\``)[1].split(/^## /m)[0];
      assert.deepEqual([...rowsOf(common), ...rowsOf(own)].sort(), optionsOf(help([], suffix)).sort(), suffix);
    }
  });
});

describe("documents.py", () => {
  let folder;
  const write = (path, text) => {
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), text);
  };
  beforeEach(() => {
    folder = mkdtempSync(join(tmpdir(), "spindrift docs "));
    assert.equal(spawnSync("git", ["init", "--quiet", folder]).status, 0);
    write(".gitignore", "/build/\n");
    write("server/net/session.cpp", "void Session::readMessages() { parse(); }\n");
    write("server/net/session.h", "class Session;\n");
    write("docs/guide.md", "# Guide\n\n## Two words, `code`\n\n## Twice\n\n## Twice\n");
  });
  afterEach(() => rmSync(folder, { recursive: true }));

  it("accepts links, anchors, functions and paths that exist", () => {
    write("pictures/a.png", "");
    write(
      "README.md",
      [
        "# Title",
        "[a](docs/guide.md) [b](docs/guide.md#two-words-code) [c](docs/guide.md#twice-1) [d](#title) [e](docs/) [f](https://example.org/x#y)",
        "![picture](pictures/a.png) [![inside](pictures/a.png)](docs/guide.md) `server/net/session.cpp:Session::readMessages`",
        "session.cpp:parse, `server/net/`, `build/release/bin/x`, `server/scenes/NAME.textproto`, `docs/*.md`",
      ].join("\n"),
    );
    assert.deepEqual(check(folder), { code: 0, faults: [] });
  });

  it("reports each wrong link, anchor, function and path, and unlinked documents, with file and line", () => {
    const cases = [
      ["[gone](docs/missing.md)", "README.md:2: link docs/missing.md: there is no docs/missing.md"],
      ["![gone](missing.png)", "README.md:2: link missing.png: there is no missing.png"],
      ["[![gone](missing.png)](docs/guide.md)", "README.md:2: link missing.png: there is no missing.png"],
      ["[a text that\ngoes on](missing.md)", "README.md:3: link missing.md: there is no missing.md"],
      ["[built](build/page.html)", "README.md:2: link build/page.html: there is no build/page.html"],
      ["[out](../other/README.md)", "README.md:2: link ../other/README.md leads out of the repository"],
      ["[anchor](docs/guide.md#two-word)", "README.md:2: link docs/guide.md#two-word: docs/guide.md has no heading #two-word"],
      ["[anchor](#nowhere)", "README.md:2: link #nowhere: README.md has no heading #nowhere"],
      ["`server/net/session.cpp:writeMessages`", "README.md:2: server/net/session.cpp:writeMessages: server/net/session.cpp does not contain that name"],
      ["session.cpp:Session::read", "README.md:2: session.cpp:Session::read: server/net/session.cpp does not contain that name"],
      ["net/sessions.cpp:read", "README.md:2: net/sessions.cpp:read: there is no such file"],
      ["`server/net/sessions.cpp`", "README.md:2: `server/net/sessions.cpp` does not exist"],
    ];
    write("build/page.html", "");
    for (const [line, fault] of cases) {
      write("README.md", `[guide](docs/guide.md)\n${line}\n`);
      assert.deepEqual(check(folder), { code: 1, faults: [fault] }, line);
    }
    write("README.md", "# Title\n");
    assert.deepEqual(check(folder), { code: 1, faults: ["docs/guide.md:1: no other document links it"] });
  });

  it("ignores links inside code, but checks functions there", () => {
    write("README.md", "[guide](docs/guide.md) `[a](b.md)`\n\n```\n# [c](d.md)\nserver/net/session.cpp:nothing\n```\n[e](f.md)\n");
    assert.deepEqual(check(folder).faults, [
      "README.md:5: server/net/session.cpp:nothing: server/net/session.cpp does not contain that name",
      "README.md:7: link f.md: there is no f.md",
    ]);
  });

  it("accepts old paths in decisions and the changelog, but no broken links", () => {
    write("README.md", "[guide](docs/guide.md) [log](CHANGELOG.md) [why](docs/decisions/001-why.md)\n");
    write("CHANGELOG.md", "`server/old/file.cpp`\n");
    write("docs/decisions/001-why.md", "`server/old/file.cpp` [x](002-gone.md)\n");
    assert.deepEqual(check(folder).faults, ["docs/decisions/001-why.md:1: link 002-gone.md: there is no docs/decisions/002-gone.md"]);
  });

  it("reports tests that do not exist, by name, by the beginning of a name and by filter", () => {
    write("tests/unit/outbox_test.cpp", "TEST(Outbox, KeepsTheOrder) {}\nTEST_P(Storm,\n       LosesNothing) {}\n");
    write("README.md", "[guide](docs/guide.md) `Outbox.KeepsTheOrder` `Outbox.Keeps…` `Other.Thing` `--gtest_filter='*Keeps*:Storm.*'` `gtest_filter=*Loses*/SCENE`\n");
    assert.deepEqual(check(folder).faults, []);
    write("README.md", "[guide](docs/guide.md)\n`Outbox.Keeps` `Storm.Keeps…`\n`--gtest_filter='*Keeps*:Outbox.Loses*'`\n");
    assert.deepEqual(check(folder).faults, [
      "README.md:2: there is no test Outbox.Keeps",
      "README.md:2: there is no test Storm.Keeps…",
      "README.md:3: no test matches Outbox.Loses*",
    ]);
  });

  it("reports decisions whose page and index name different successors", () => {
    const row = (note) => `| [001](001-why.md) | Why | Because. ${note} |\n`;
    const page = (line) => `# 1. Why\n\n${line}\n\n**Context.** A [link](../guide.md).\n`;
    const fault = "docs/decisions/001-why.md:1: the index names other decisions that supersede it";
    write("README.md", "[guide](docs/guide.md) [index](docs/decisions/README.md)\n");
    for (const [line, note, faults] of [
      ["Superseded by decision [2](001-why.md).", "Superseded by 2.", []],
      ["Superseded in part by decisions [2](001-why.md) and [3](001-why.md): a part.", "In part superseded by 2 and 3.", []],
      ["Superseded by decision [2](001-why.md).", "", [fault]],
      ["**Context.** None.", "Superseded by 2.", [fault]],
      ["Superseded by decision [2](001-why.md).", "Superseded by 3.", [fault]],
    ]) {
      write("docs/decisions/README.md", row(note));
      write("docs/decisions/001-why.md", page(line));
      assert.deepEqual(check(folder).faults, faults, `${line} ${note}`);
    }
  });
});
