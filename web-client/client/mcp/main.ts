#!/usr/bin/env node
// spindrift-mcp: lets an agent use a server of water, over standard input and output.
import { readFileSync } from "node:fs";
import { parseArgs } from "node:util";

const kUsage = `usage: spindrift-mcp [URL] [--token-file FILE]

A server of the Model Context Protocol on standard input and output. URL: of the water, http://localhost:8080 if left out. The token gives the
role of the agent: the first line of FILE, or the variable SPINDRIFT_TOKEN, or that of the URL (#token=...); without one the agent is a guest.
`;

/** Only this program needs these, so the package does not bring them. */
function explained(error: unknown): string {
  const isMissing = error instanceof Error && "code" in error && error.code === "ERR_MODULE_NOT_FOUND";
  return isMissing ? `install what it needs besides: npm install @modelcontextprotocol/server zod fast-png (${error.message})` : error instanceof Error ? error.message : String(error);
}

try {
  const { values, positionals } = parseArgs({ allowPositionals: true, options: { "token-file": { type: "string" }, help: { type: "boolean" } } });
  if (positionals.length > 1) throw new Error(`one URL is expected, there are ${positionals.length}`);
  if (values.help) process.stdout.write(kUsage);
  else {
    const file = values["token-file"];
    const token = file === undefined ? (process.env["SPINDRIFT_TOKEN"] ?? "") : readFileSync(file, "utf8").split("\n")[0]!.trim();
    const { serve } = await import("./serve");
    serve(positionals[0] ?? "http://localhost:8080", token);
  }
} catch (error) {
  process.stderr.write(`spindrift-mcp: ${explained(error)}\n${kUsage}`);
  process.exitCode = 2;
}
