// Connects to a dashboard with the official client of the Foxglove WebSocket protocol and calls methods of the client.
// Prints each message about parameters, and each status, as a line of JSON until it is killed.
//   node foxglove_client.mjs PORT SUBPROTOCOL '[["getParameters", [], "all"], ...]'
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const [port, subprotocol, calls] = process.argv.slice(2);
const socket = new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]);
const client = new protocol.FoxgloveClient({ ws: socket });
const print = (event) => console.log(JSON.stringify(event));

client.on("error", (error) => {
  console.error(String(error));
  process.exit(1);
});
client.on("parameterValues", print);
client.on("status", print);
client.on("serverInfo", (info) => {
  print({ ...info, subprotocol: socket.protocol });
  for (const [method, ...args] of JSON.parse(calls)) client[method](...args);
});
