// A client of the Foxglove WebSocket protocol: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
// It connects again by itself for as long as the page is open.

const again_ms = 1000;
const silent_ms = 3000; // the dashboard sends at least twice a second

export class Connection {
  /** `topics`: those to subscribe to. `on`: functions `message(topic, view, from)`, `change(text, kind)`,
   * `parameters(values)` with the name and value of each changed parameter, also if another client changed it. */
  constructor(topics, on) {
    this.topics = topics;
    this.on = on;
    this.services = {}; // id by name
    this.calls = new Map(); // {name, done, fail} by number
    this.number = 0;
    this.arrived = 0; // time of the last message
    this.ended = null; // why the dashboard is about to end
    this.connect();
    setInterval(() => this.watch(), 500);
  }

  get open() {
    return this.socket.readyState === WebSocket.OPEN && Object.keys(this.services).length > 0;
  }
  has(service) {
    return this.open && service in this.services;
  }

  connect() {
    this.services = {};
    if (!this.ended) this.on.change("connecting", "");
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    this.socket = new WebSocket(`${scheme}//${location.host}/`, ["foxglove.sdk.v1"]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = (message) => {
      if (typeof message.data === "string") this.takeText(JSON.parse(message.data));
      else this.takeFrame(new DataView(message.data));
    };
    this.socket.onclose = () => {
      const calls = [...this.calls.values()];
      this.services = {};
      this.calls.clear();
      if (this.ended) this.on.change(`${this.ended}; waiting for the next one`, "");
      else this.on.change("not connected; trying again", "bad");
      for (const call of calls) call.fail(new Error(`${call.name}: the connection was lost before the answer`));
      setTimeout(() => this.connect(), again_ms);
    };
  }

  watch() {
    if (!this.open || this.arrived === 0) return;
    if (performance.now() - this.arrived > silent_ms) this.on.change("connected, but nothing arrives", "bad");
  }

  takeText(message) {
    if (message.op === "advertise") {
      const list = message.channels
        .filter((channel) => this.topics.includes(channel.topic))
        .map((channel) => ({ id: this.topics.indexOf(channel.topic) + 1, channelId: channel.id }));
      if (list.length > 0) this.socket.send(JSON.stringify({ op: "subscribe", subscriptions: list }));
    } else if (message.op === "advertiseServices") {
      for (const service of message.services) this.services[service.name] = service.id;
      this.ended = null;
      this.on.change("connected", "good");
      this.socket.send(JSON.stringify({ op: "subscribeParameterUpdates", parameterNames: [] }));
    } else if (message.op === "parameterValues") {
      this.on.parameters(message.parameters);
    } else if (message.op === "status" && message.id === "end") {
      this.ended = message.message;
      this.on.change(this.ended, "");
    } else if (message.op === "serviceCallFailure") {
      this.calls.get(message.callId)?.fail(new Error(message.message));
      this.calls.delete(message.callId);
    }
  }

  takeFrame(view) {
    const kind = view.getUint8(0);
    if (kind === 3) {
      const number = view.getUint32(5, true);
      const answer = JSON.parse(new TextDecoder().decode(new Uint8Array(view.buffer, 13 + view.getUint32(9, true))));
      this.calls.get(number)?.done(answer.text);
      this.calls.delete(number);
    }
    if (kind !== 1) return;
    const silent = performance.now() - this.arrived > silent_ms;
    this.arrived = performance.now();
    if (silent) this.on.change("connected", "good");
    this.on.message(this.topics[view.getUint32(1, true) - 1], view, 13);
  }

  /** Calls a service. The promise has the text of its answer, or fails with the reason of its refusal. */
  call(name, request) {
    return new Promise((done, fail) => {
      if (!this.has(name)) return fail(new Error(`${name}: not connected`));
      const body = new TextEncoder().encode(JSON.stringify(request));
      const frame = new DataView(new ArrayBuffer(17 + body.length));
      const number = ++this.number;
      frame.setUint8(0, 2);
      frame.setUint32(1, this.services[name], true);
      frame.setUint32(5, number, true);
      frame.setUint32(9, 4, true);
      new TextEncoder().encodeInto("json", new Uint8Array(frame.buffer, 13, 4));
      new Uint8Array(frame.buffer, 17).set(body);
      this.calls.set(number, { name, done, fail });
      this.socket.send(frame.buffer);
    });
  }
}
