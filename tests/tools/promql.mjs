// What an expression of PromQL asks of the metrics: which ones, with which labels, in which functions. Knows what rules and
// dashboard of this repository use; promtool checks the syntax.

/** Functions for counters, over a range. */
const COUNTER_FUNCTIONS = new Set(["rate", "irate", "increase", "resets"]);
/** Labels that Prometheus adds to every sample. */
const TARGET_LABELS = ["instance", "job"];

/** The metric with this name. A histogram has three, which are counters: its name with an ending. */
export function metricNamed(metrics, name) {
  const whole = metrics.get(name.replace(/_(bucket|sum|count)$/, ""));
  if (whole?.type !== "histogram") return metrics.get(name);
  if (whole === metrics.get(name)) return undefined;
  return { type: "counter", labels: name.endsWith("_bucket") ? whole.labels : whole.labels.filter((label) => label !== "le") };
}

/** Index behind the bracket that closes the one at `start`. */
function endOf(text, start) {
  let depth = 0;
  for (let at = start; at < text.length; ++at) {
    if (text[at] === "(") ++depth;
    if (text[at] === ")" && --depth === 0) return at + 1;
  }
  throw new Error(`no closing bracket: ${text}`);
}

/** [{ name, matchers: [{ label, values }], hasRange, inFunction, at }] for every metric of the server. */
export function selectorsOf(expr) {
  const pattern = /\bspindrift_(\w+)(\{[^}]*\})?(\[[^\]]+\])?/g;
  return [...expr.matchAll(pattern)].map((match) => ({
    name: match[1],
    at: match.index,
    matchers: [...(match[2] ?? "").matchAll(/(\w+)\s*(?:=~|!~|!=|=)\s*"([^"]*)"/g)].map(([, label, values]) => ({ label, values: values.split("|") })),
    hasRange: match[3] !== undefined,
    inFunction: expr.slice(0, match.index).match(/(\w+)\s*\(\s*$/)?.[1],
  }));
}

/** [{ labels, begin, end }] for `by (…)`, with the range of what is aggregated. */
function groupingsOf(expr) {
  return [...expr.matchAll(/\bby\s*\(([^)]*)\)\s*/g)].map((match) => {
    const begin = match.index + match[0].length;
    if (expr[begin] !== "(") throw new Error(`write "sum by (labels) (expression)": ${expr}`);
    return { labels: match[1].split(",").map((label) => label.trim()), begin, end: endOf(expr, begin) };
  });
}

/** Labels of the samples that the expression results in. */
function labelsAfter(expr, metrics) {
  const groupings = groupingsOf(expr);
  if (groupings.length > 0) return groupings[0].labels;
  if (/\b(sum|count|absent|max|min)\s*\(/.test(expr) && !/\bor\b/.test(expr)) return [];
  return [...TARGET_LABELS, ...selectorsOf(expr).flatMap(({ name }) => metricNamed(metrics, name)?.labels ?? [])];
}

/**
 * Returns what is wrong with the expression, one line each.
 * @param texts legends and annotations that name labels of the result: {{room}} or {{ $labels.room }}
 */
export function faultsOf(expr, metrics, texts = []) {
  const faults = [];
  const selectors = selectorsOf(expr);
  for (const { name, matchers, hasRange, inFunction } of selectors) {
    const metric = metricNamed(metrics, name);
    if (!metric) {
      faults.push(`the server has no metric spindrift_${name}`);
      continue;
    }
    if (metric.type === "counter" && !(COUNTER_FUNCTIONS.has(inFunction) && hasRange)) faults.push(`${name} is a counter: use rate() or increase()`);
    if (metric.type === "gauge" && COUNTER_FUNCTIONS.has(inFunction)) faults.push(`${name} is a gauge: ${inFunction}() is for counters`);
    for (const { label } of matchers) {
      if (![...TARGET_LABELS, ...metric.labels].includes(label)) faults.push(`${name} has no label ${label}`);
    }
  }
  for (const { labels, begin, end } of groupingsOf(expr)) {
    for (const { name, at } of selectors.filter((selector) => selector.at >= begin && selector.at < end)) {
      const known = [...TARGET_LABELS, ...(metricNamed(metrics, name)?.labels ?? labels)];
      for (const label of labels.filter((wanted) => !known.includes(wanted))) faults.push(`${name} has no label ${label}`);
    }
  }
  const results = labelsAfter(expr, metrics);
  for (const text of texts) {
    for (const [, label] of text.matchAll(/\{\{\s*(?:\$labels\.)?(\w+)\s*\}\}/g)) {
      if (!results.includes(label)) faults.push(`the result has no label ${label}, which "${text}" names`);
    }
  }
  return faults;
}
