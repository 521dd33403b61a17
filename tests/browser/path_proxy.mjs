// A reverse proxy that serves a server under a path, which it takes away, and refuses everything else.
import { createServer, request } from "node:http";
import { connect } from "node:net";

/**
 * @param {number} server_port of the server behind it
 * @param {string} base "/water/"
 * @returns {Promise<{url: string, outside: string[], close: () => void}>} `outside`: the paths asked for that are not under the base
 */
export async function startPathProxy(server_port, base) {
  const outside = [];
  const sockets = new Set();
  const inside = (url) => (url.startsWith(base) ? url.slice(base.length - 1) : (outside.push(url), undefined));
  const proxy = createServer((asked, answer) => {
    const path = inside(asked.url);
    if (path === undefined) return answer.writeHead(404).end();
    const passed = request({ port: server_port, host: "127.0.0.1", path, method: asked.method, headers: asked.headers }, (reply) => {
      answer.writeHead(reply.statusCode, reply.headers);
      reply.pipe(answer);
    });
    passed.on("error", () => answer.destroy());
    asked.pipe(passed);
  });
  proxy.on("connection", (socket) => sockets.add(socket.on("close", () => sockets.delete(socket))));
  proxy.on("upgrade", (asked, client, head) => {
    const path = inside(asked.url);
    if (path === undefined) return client.end("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n");
    const server = connect(server_port, "127.0.0.1", () => {
      const lines = asked.rawHeaders.flatMap((text, i, all) => (i % 2 === 0 ? [`${text}: ${all[i + 1]}`] : []));
      server.write(`GET ${path} HTTP/1.1\r\n${lines.join("\r\n")}\r\n\r\n`);
      server.write(head);
      server.pipe(client).pipe(server);
    });
    for (const [one, other] of [[client, server], [server, client]]) one.on("error", () => other.destroy()).on("close", () => other.destroy());
  });
  proxy.listen(0, "127.0.0.1");
  await new Promise((resolve) => proxy.on("listening", resolve));
  const close = () => {
    proxy.close();
    for (const socket of sockets) socket.destroy();
  };
  return { url: `http://127.0.0.1:${proxy.address().port}${base}`, outside, close };
}
