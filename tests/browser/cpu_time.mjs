// Processor time of a process and its descendants, by what they do in a browser; unlike wall time it does not depend on what else runs on the machine.
import { readdirSync, readFileSync } from "node:fs";

const kTicksPerS = 100;

/** Returns undefined for a process that has ended. */
function read(path) {
  try {
    return readFileSync(path, "utf8");
  } catch {
    return undefined;
  }
}

/** `/proc/PID/stat`: parent, and time in user and system mode [s]. */
function statOf(pid) {
  const fields = read(`/proc/${pid}/stat`)?.replace(/^.*\) /s, "").split(" ");
  return fields && { parent: Number(fields[1]), cpuS: (Number(fields[11]) + Number(fields[12])) / kTicksPerS };
}

/** Returns the processor time used so far [s] by the processes whose command line contains `mark` and their descendants, by their kind (`--type=`). */
export function cpuSecondsOf(mark) {
  const pids = readdirSync("/proc").filter((name) => /^\d+$/.test(name));
  const stats = new Map(pids.map((pid) => [Number(pid), statOf(pid)]).filter(([, stat]) => stat));
  const lines = new Map([...stats.keys()].map((pid) => [pid, read(`/proc/${pid}/cmdline`) ?? ""]));
  const belongs = (pid) => stats.has(pid) && (lines.get(pid).includes(mark) || belongs(stats.get(pid).parent));
  const sums = {};
  for (const [pid, { cpuS }] of stats) {
    if (!belongs(pid)) continue;
    const kind = /--type=([\w-]+)/.exec(lines.get(pid))?.[1] ?? "browser";
    sums[kind] = (sums[kind] ?? 0) + cpuS;
  }
  return sums;
}
