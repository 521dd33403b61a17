// A client built from the npm package `ws` and the messages generated from proto/, without the page's own connection.
import { create, fromBinary, toBinary } from "../../web-client/node_modules/@bufbuild/protobuf";
import WebSocket from "ws";

import { parse } from "../../web-client/client/codec/parse";
import { ClientMessageSchema, ServerMessageSchema } from "../../web-client/client/gen/spindrift/v1/wire_pb";

/** Far longer than any step; only a failing test reaches it. */
const kPatienceMs = 60_000;

export class Client {
  /** Parsed messages that were received and not yet read. */
  #inbox = [];
  #wake = () => {};
  #first;

  constructor(port, path = "/ws") {
    this.ws = new WebSocket(`ws://127.0.0.1:${port}${path}`, "spindrift.v1");
    this.ws.binaryType = "arraybuffer";
    this.closed = new Promise((resolve) => this.ws.on("close", (code, reason) => resolve({ code, reason: String(reason) })));
    this.ws.on("message", (data, is_binary) => {
      this.#first ??= data;
      this.#inbox.push(is_binary ? parse(data) : { kind: "text" });
      this.#wake();
    });
    this.ws.on("error", () => {}); // "close" follows
  }

  /** Returns a client that has received its greeting and says that it speaks this version. */
  static async greeted(port, version) {
    const client = new Client(port);
    await client.nextOf("greeting");
    client.hello(version);
    return client;
  }

  /** Returns the first message that `accept` accepts and drops the ones before it. Rejects when the socket is closed or after kPatienceMs. */
  async next(accept) {
    const deadline_ms = Date.now() + kPatienceMs;
    for (;;) {
      while (this.#inbox.length > 0) {
        const message = this.#inbox.shift();
        if (accept(message)) return message;
      }
      const news = new Promise((resolve) => {
        this.#wake = () => resolve(true);
      });
      let timer;
      const patience = new Promise((resolve) => {
        timer = setTimeout(() => resolve(false), Math.max(0, deadline_ms - Date.now()));
      });
      const more = await Promise.race([news, patience, this.closed.then(() => this.#inbox.length > 0)]);
      clearTimeout(timer);
      if (!more) throw new Error(`what was waited for did not come (socket state ${this.ws.readyState})`);
    }
  }
  nextOf(kind) {
    return this.next((message) => message.kind === kind);
  }

  /** Reads the greeting's limit; parse() leaves it out, because the page does not need it. */
  messageMaxBytes() {
    return fromBinary(ServerMessageSchema, new Uint8Array(this.#first)).message.value.limits.messageMaxBytes;
  }

  send(message) {
    this.ws.send(Client.bytesOf(message));
  }
  static bytesOf(message) {
    return toBinary(ClientMessageSchema, create(ClientMessageSchema, { message }));
  }
  hello({ major = 1, minor = 0 } = {}) {
    this.send({ case: "hello", value: { version: { major, minor }, client: "ws" } });
  }
  subscribe(layer, packing, more = {}) {
    this.send({ case: "subscribe", value: { layer, packing, maxRateHz: 60, ...more } });
  }
  command(commandId, action) {
    this.send({ case: "command", value: { commandId, action } });
  }

  /** Closes the connection; returns the server's code and reason. */
  async close(code = 1000) {
    this.ws.close(code);
    return this.closed;
  }
}
