// Reads the part of YAML that docker/observability uses: maps and lists by indentation, [lists] and {maps} of plain words,
// quoted and plain scalars, `|` blocks, comments. Anything else is an error, so a file cannot be misread.

const KEY = /^([\w-]+):(?:\s+(.*))?$/;

function scalar(text, line) {
  if (/^"(?:[^"\\]|\\["\\n])*"$/.test(text)) return JSON.parse(text);
  if (/^'(?:[^']|'')*'$/.test(text)) return text.slice(1, -1).replaceAll("''", "'");
  if (text.startsWith("[") && text.endsWith("]")) return text.slice(1, -1).split(",").map((item) => scalar(item.trim(), line));
  if (/^["'[\]{}&*!|>%@`]/.test(text) || /: | #|:$/.test(text)) throw new Error(`line ${line}: quote ${text}`);
  if (/^-?\d+(\.\d+)?$/.test(text)) return Number(text);
  if (["true", "false", "null", "yes", "no", "on", "off", "~"].includes(text)) throw new Error(`line ${line}: quote ${text}`);
  return text;
}

export function parsePlainYaml(text) {
  const lines = text.split("\n").map((raw, index) => ({ raw, indent: raw.search(/\S/), text: raw.trim(), number: index + 1 }));
  if (text.includes("\t")) throw new Error("a tab: indent with spaces");
  let at = 0;
  const skip = () => {
    while (at < lines.length && (lines[at].text === "" || lines[at].text.startsWith("#"))) ++at;
    return lines[at];
  };

  /** The value behind `key:`, whose line has the indentation `indent`. */
  const value = (rest, indent) => {
    const { number } = lines[at];
    ++at;
    if (rest === "|") {
      const block = [];
      while (at < lines.length && (lines[at].text === "" || lines[at].indent > indent)) block.push(lines[at++].raw);
      const margin = Math.min(...block.filter((line) => line.trim()).map((line) => line.search(/\S/)));
      return `${block.map((line) => line.slice(margin)).join("\n").trimEnd()}\n`;
    }
    if (rest !== undefined && !rest.startsWith("#")) return scalar(rest, number);
    const next = skip();
    if (!next || next.indent <= indent) throw new Error(`line ${number}: no value`);
    return node(next.indent);
  };

  const map = (indent) => {
    const out = {};
    for (let line = skip(); line && line.indent === indent && !line.text.startsWith("- "); line = skip()) {
      const match = line.text.match(KEY);
      if (!match) throw new Error(`line ${line.number}: not "key: value": ${line.text}`);
      if (match[1] in out) throw new Error(`line ${line.number}: ${match[1]} is there twice`);
      out[match[1]] = value(match[2], indent);
    }
    return out;
  };

  const list = (indent) => {
    const out = [];
    for (let line = skip(); line && line.indent === indent && line.text.startsWith("- "); line = skip()) {
      const item = line.text.slice(2).trim();
      if (KEY.test(item)) {
        // The first key stands behind the dash; the others are indented as far.
        lines[at] = { ...line, raw: line.raw.replace("- ", "  "), indent: indent + 2, text: item };
        out.push(map(indent + 2));
      } else {
        out.push(scalar(item, line.number));
        ++at;
      }
    }
    return out;
  };

  const node = (indent) => (lines[at].text.startsWith("- ") ? list(indent) : map(indent));

  const out = skip() ? node(0) : {};
  const left = skip();
  if (left) throw new Error(`line ${left.number}: wrong indentation: ${left.raw}`);
  return out;
}
