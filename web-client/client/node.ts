// In Node the sockets are those of the npm package ws: Node 20 has none of its own.
import WebSocket from "ws";

import { connect as connectWith, type ConnectOptions, type Water } from "./index";

export * from "./index";

/** As in index.ts. */
export function connect(url: string | URL, options: ConnectOptions = {}): Promise<Water> {
  return connectWith(url, { WebSocket, ...options });
}
