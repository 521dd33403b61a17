// Reads which metrics the server has from server/service/metrics.cpp: name -> { type, labels }.
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { repository } from "./workshop.mjs";

/** Labels that the code puts on samples: with metricLabel("name", …), or the label of a room that was made before. */
function labelsIn(code) {
  const written = [...code.matchAll(/metricLabel\("(\w+)"/g)].map((match) => match[1]);
  const isOfRoom = /\broom\.label\b|\[label, status\]/.test(code);
  return [...new Set([...(isOfRoom ? ["room"] : []), ...written])];
}

/** The text from `start` to the bracket that closes the first one there. */
function bracketed(code, start, open, close) {
  let depth = 0;
  for (let at = code.indexOf(open, start); at < code.length; ++at) {
    if (code[at] === open) ++depth;
    if (code[at] === close && --depth === 0) return code.slice(start, at + 1);
  }
  throw new Error(`metrics.cpp: no closing ${close}`);
}

export function readMetrics(source = readFileSync(join(repository, "server/service/metrics.cpp"), "utf8")) {
  const metrics = new Map();
  const add = (name, type, labels) => {
    if (metrics.has(name)) throw new Error(`metrics.cpp: ${name} is there twice`);
    metrics.set(name, { type, labels });
  };
  for (const body of source.split(/^(?:void|std::string) /m).slice(1)) {
    // Functions that write a metric each: const auto each = [&](const char* name, …) { page.head(name, type or "gauge", help); … };
    let rest = body;
    const writers = new Map();
    for (const match of body.matchAll(/const auto (\w+) = \[&\]\(const char\* name/g)) {
      const code = bracketed(body, match.index, "{", "}");
      rest = rest.replace(code, "");
      const type = code.match(/page\.head\(name, (?:type|"(\w+)")/);
      if (!type) throw new Error(`metrics.cpp: ${match[1]} has no page.head(name, …)`);
      writers.set(match[1], { type: type[1], labels: labelsIn(code) });
    }
    // Calls of them, of page.one, and of page.head itself, whose samples follow.
    writers.set("page.one", { labels: [] });
    const calls = [...rest.matchAll(/\b(page\.(?:head|one)|\w+)\(\s*"([a-z_]+)",\s*"([^"]*)"/g)].filter(
      ([, writer]) => writer === "page.head" || writers.has(writer),
    );
    calls.forEach((call, index) => {
      const [, writer, name, second] = call;
      const known = writers.get(writer);
      if (known) return add(name, known.type ?? second, known.labels);
      return add(name, second, labelsIn(rest.slice(call.index, calls[index + 1]?.index)));
    });
  }
  return metrics;
}
