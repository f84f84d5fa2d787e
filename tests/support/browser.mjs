// Opens a page in headless Chromium and carries out the steps of a test, by the Chrome DevTools Protocol over pipes.
// Usage: node browser.mjs URL WIDTHxHEIGHT STEP...
//   wait=EXPRESSION      until this JavaScript is true in the page, at most 30 s
//   click=SELECTOR       with the mouse
//   print=EXPRESSION     a line with its value as JSON
//   shot=FILE            a picture (.png, .jpg) of the whole page
//   line                 waits for a line on standard input
// Ends with status 1 if a wait is in vain or the page throws.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

const [url, size, ...steps] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const folder = mkdtempSync(join(tmpdir(), "constrictor-browser-"));
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();

const chromium = spawn("chromium", [
  "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
  "--remote-debugging-pipe", `--user-data-dir=${folder}`, "about:blank",
], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });

async function until(what, bound, check) {
  const end = Date.now() + bound;
  for (;;) {
    const value = await check();
    if (value) return value;
    if (Date.now() > end) throw new Error(`${what}: not within ${bound} ms`);
    await pause(20);
  }
}

class Page {
  constructor() {
    this.number = 0;
    this.waiting = new Map();
    this.errors = [];
    let text = "";
    chromium.stdio[4].on("data", (data) => {
      text += data;
      const messages = text.split("\0"); // each ends with a zero byte
      text = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
  }
  take(message) {
    if (message.method === "Runtime.exceptionThrown")
      this.errors.push(message.params.exceptionDetails.exception?.description ?? "exception");
    this.waiting.get(message.id)?.(message);
    this.waiting.delete(message.id);
  }
  call(method, params = {}) {
    return new Promise((done, fail) => {
      const id = ++this.number;
      this.waiting.set(id, ({ result, error }) => (error ? fail(new Error(`${method}: ${error.message}`)) : done(result)));
      chromium.stdio[3].write(JSON.stringify({ id, method, params, sessionId: this.session }) + "\0");
    });
  }
  async value(expression) {
    const { result, exceptionDetails } = await this.call("Runtime.evaluate", { expression, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
    return result.value;
  }
  async click(selector) {
    const place = await this.value(`(() => { const e = document.querySelector(${JSON.stringify(selector)});
      e.scrollIntoView({block: "center"}); const b = e.getBoundingClientRect();
      return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
    for (const type of ["mousePressed", "mouseReleased"])
      await this.call("Input.dispatchMouseEvent", { type, x: place[0], y: place[1], button: "left", clickCount: 1 });
  }
}

async function open() {
  const page = new Page();
  const { targetId } = await page.call("Target.createTarget", { url: "about:blank" });
  page.session = (await page.call("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  await page.call("Runtime.enable");
  await page.call("Page.enable");
  await page.call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 600 });
  await page.call("Page.navigate", { url });
  await until(`loading ${url}`, 20000, () =>
    page.value("document.readyState === 'complete' && location.protocol.startsWith('http')"));
  return page;
}

async function carryOut(page, step) {
  const equals = step.indexOf("=");
  const [name, value] = equals < 0 ? [step, ""] : [step.slice(0, equals), step.slice(equals + 1)];
  if (name === "wait") await until(value, 30000, () => page.value(`!!(${value})`));
  else if (name === "click") await page.click(value);
  else if (name === "print") console.log(JSON.stringify(await page.value(value)));
  else if (name === "line") await lines.next();
  else if (name === "shot") {
    const format = value.endsWith(".jpg") ? "jpeg" : "png";
    const { data } = await page.call("Page.captureScreenshot", { captureBeyondViewport: true, format });
    writeFileSync(value, Buffer.from(data, "base64"));
  } else throw new Error(`unknown step ${step}`);
}

let status = 0;
try {
  const page = await open();
  for (const step of steps) await carryOut(page, step);
  if (page.errors.length > 0) throw new Error(`the page threw: ${page.errors.slice(0, 3).join("; ")}`);
} catch (error) {
  console.error(String(error.message ?? error));
  status = 1;
}
const ended = new Promise((done) => chromium.once("exit", done));
chromium.kill("SIGKILL");
await ended;
rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
process.exit(status);
