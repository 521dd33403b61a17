// Serves the tools over standard input and output until the input ends.
import { serveStdio } from "@modelcontextprotocol/server/stdio";

import { connect } from "../node";
import { Rooms } from "./rooms";
import { waterTools } from "./tools";

/** Version of the program; the build defines it. */
declare const __PROGRAM_VERSION__: string;

export function serve(url: string, token: string): void {
  const rooms = new Rooms(url, token, connect);
  const handle = serveStdio(() => waterTools(rooms, __PROGRAM_VERSION__));
  const end = (): void => {
    rooms.close();
    void handle.close();
  };
  for (const signal of ["SIGINT", "SIGTERM"] as const) process.once(signal, end);
  process.stdin.once("end", end);
}
