/** What node.ts uses of the npm package ws. */
declare module "ws" {
  const WebSocket: new (url: string, subprotocol: string) => unknown;
  export default WebSocket;
}
