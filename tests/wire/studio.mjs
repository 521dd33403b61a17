// Foxglove's own client (npm @foxglove/ws-protocol), which reads channels with nothing but the schemas that the server sends.
import { createFileRegistry, fromBinary } from "../../web-client/node_modules/@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "../../web-client/node_modules/@bufbuild/protobuf/dist/esm/wkt";
import { FoxgloveClient } from "@foxglove/ws-protocol";
import WebSocket from "ws";

const kPatienceMs = 60_000;

/** Foxglove's client, with what has come kept until it is read. */
export class Studio {
  constructor(port, { path = "/foxglove", token, protocols = ["foxglove.sdk.v1", "foxglove.websocket.v1"], origin } = {}) {
    this.ws = new WebSocket(`ws://127.0.0.1:${port}${path}${token ? `?access_token=${token}` : ""}`, protocols, origin === undefined ? {} : { origin });
    this.closed = new Promise((resolve) => this.ws.on("close", (code, reason) => resolve({ code, reason: String(reason) })));
    this.refused = new Promise((resolve) => this.ws.on("unexpected-response", (_request, response) => resolve(response.statusCode)));
    this.client = new FoxgloveClient({ ws: this.ws });
    this.log = {};
    this.errors = [];
    this.channels = new Map();
    for (const event of ["serverInfo", "status", "message", "time", "parameterValues", "serviceCallResponse", "serviceCallFailure"]) {
      this.log[event] = [];
      this.client.on(event, (value) => {
        this.log[event].push(value);
        if (this.log[event].length > 500) this.log[event].shift();
      });
    }
    this.client.on("advertise", (list) => list.forEach((channel) => this.channels.set(channel.topic, channel)));
    this.client.on("unadvertise", (ids) => [...this.channels.values()].filter(({ id }) => ids.includes(id)).forEach(({ topic }) => this.channels.delete(topic)));
    this.client.on("advertiseServices", (list) => (this.services = new Map(list.map((service) => [service.name, service]))));
    this.client.on("error", (error) => this.errors.push(error));
  }

  /** Returns the first value of the event, from now on or kept, that `accept` accepts, and forgets those before it. */
  async next(event, accept = () => true) {
    return this.until(() => {
      const at = this.log[event].findIndex(accept);
      return at < 0 ? undefined : this.log[event].splice(0, at + 1).at(-1);
    }, event);
  }
  async until(look, what = "what was waited for") {
    for (const deadline_ms = Date.now() + kPatienceMs; Date.now() < deadline_ms; await new Promise((done) => setTimeout(done, 20))) {
      const found = look();
      if (found) return found;
    }
    throw new Error(`${what} did not come; statuses: ${JSON.stringify(this.log.status)}, errors: ${this.errors}`);
  }
  ready() {
    return this.until(() => this.services && this.channels.size > 0, "advertise");
  }
  subscribe(topic) {
    const channel = this.channels.get(topic);
    const files = fromBinary(FileDescriptorSetSchema, Buffer.from(channel.schema, "base64"));
    const schema = createFileRegistry(files).getMessage(channel.schemaName);
    const id = this.client.subscribe(channel.id);
    return {
      id,
      next: async (accept = () => true) => {
        for (;;) {
          const { data } = await this.next("message", ({ subscriptionId }) => subscriptionId === id);
          const message = fromBinary(schema, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
          if (accept(message)) return message;
        }
      },
    };
  }
  #calls = 0;
  async call(name, request) {
    const callId = ++this.#calls;
    this.client.sendServiceCallRequest({ serviceId: this.services.get(name).id, callId, encoding: "json", data: new TextEncoder().encode(request) });
    return this.until(() => {
      const answer = this.log.serviceCallResponse.find((one) => one.callId === callId);
      return answer ? JSON.parse(new TextDecoder().decode(answer.data)) : this.log.serviceCallFailure.find((one) => one.callId === callId);
    }, `an answer of ${name}`);
  }
  async close() {
    this.client.close();
    return this.closed;
  }
}

/** Elements of packed data as objects, by the names of their fields. */
export function elements({ fields, data }, stride) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const read = { 1: (at) => view.getUint8(at), 7: (at) => view.getFloat32(at, true) };
  return Array.from({ length: data.byteLength / stride }, (_, i) =>
    Object.fromEntries(fields.map(({ name, offset, type }) => [name, read[type](i * stride + offset)])));
}

export const heightsOf = (grid) => elements(grid, grid.cellStride).map((cell) => cell.elevation_m);
