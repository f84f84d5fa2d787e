// Opens a page in headless Chromium and carries out the steps of a test, by the Chrome DevTools Protocol over pipes.
// Usage: node browser.mjs URL WIDTHxHEIGHT STEP...
//   wait=EXPRESSION      until this JavaScript is true in the page, at most 60 s
//   click=SELECTOR       with the mouse
//   print=EXPRESSION     a line with its value as JSON
//   shot=FILE            a picture (.png, .jpg) of the whole page
//   view=FILE            a picture of what the screen shows
//   colours=N SELECTOR   until this element shows more than N distinct colours, WebGL included
//   shows=R,G,B SELECTOR until this element shows at least 20 pixels of about this colour
//   press=SELECTOR       holds the mouse button down in the element, at 3/4 of its width and 1/4 of its height
//   let                  lets the mouse button go
//   down=KEY, up=KEY     holds a key ("ArrowUp") down, lets it go
//   frames=SECONDS       a line of JSON with the time [ms] for which the page's main thread works in each frame
//   line                 waits for a line on standard input
// Ends with status 1 if a wait is in vain or the page throws, with the picture of the next step view. CONSTRICTOR_BROWSER_FLAGS: more arguments of Chromium.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

const [url, size, ...steps] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const folder = mkdtempSync(join(tmpdir(), "constrictor-browser-"));
const kPatience = 60000; // ms; a busy machine draws a page slowly
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();

const chromium = spawn("chromium", [
  "--headless", "--no-sandbox", "--no-first-run", "--disable-background-networking", "--enable-unsafe-swiftshader",
  ...(process.env.CONSTRICTOR_BROWSER_FLAGS ?? "").split(" ").filter((flag) => flag),
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
    this.traced = [];
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
    if (message.method === "Tracing.dataCollected") this.traced.push(...message.params.value);
    if (message.method === "Tracing.tracingComplete") this.traceDone?.();
    this.waiting.get(message.id)?.(message);
    this.waiting.delete(message.id);
  }
  call(method, params = {}, sessionId = this.session) {
    return new Promise((done, fail) => {
      const id = ++this.number;
      this.waiting.set(id, ({ result, error }) => (error ? fail(new Error(`${method}: ${error.message}`)) : done(result)));
      chromium.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    });
  }
  async value(expression) {
    const { result, exceptionDetails } =
      await this.call("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
    return result.value;
  }
  /** Brings an element into view; its place in the window. */
  place(selector) {
    return this.value(`(() => { const e = document.querySelector(${JSON.stringify(selector)});
      e.scrollIntoView({block: "center"}); const { x, y, width, height } = e.getBoundingClientRect();
      return { x, y, width, height }; })()`);
  }
  mouse(type, x, y) {
    return this.call("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1, clickCount: 1 });
  }
  async click(selector) {
    const { x, y, width, height } = await this.place(selector);
    for (const type of ["mousePressed", "mouseReleased"]) await this.mouse(type, x + width / 2, y + height / 2);
  }
  async press(selector) {
    const { x, y, width, height } = await this.place(selector);
    this.held = [x + 0.75 * width, y + 0.25 * height];
    await this.mouse("mousePressed", ...this.held);
  }
  /** The colours of an element, as [R, G, B, pixels]. From a picture of the screen, because the pixels of WebGL cannot
   * be read when they have been shown. */
  async colours(selector) {
    if (!(await this.value(`!!document.querySelector(${JSON.stringify(selector)})`))) return [];
    const clip = { ...(await this.place(selector)), scale: 1 };
    if (clip.width === 0 || clip.height === 0) return []; // hidden
    const scrolled = await this.value("[scrollX, scrollY]");
    clip.x += scrolled[0];
    clip.y += scrolled[1];
    const { data } = await this.call("Page.captureScreenshot", { clip, captureBeyondViewport: true });
    return this.value(`(async () => {
      const bytes = Uint8Array.from(atob(${JSON.stringify(data)}), (c) => c.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      const counts = new Map();
      for (const pixel of new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer))
        counts.set(pixel, (counts.get(pixel) ?? 0) + 1);
      return [...counts].map(([pixel, count]) => [pixel & 255, pixel >> 8 & 255, pixel >> 16 & 255, count]); })()`);
  }
  /** The events of the browser in this time. Tracing belongs to the browser, not to the page. */
  async trace(seconds) {
    this.traced = [];
    const done = new Promise((end) => (this.traceDone = end));
    const includedCategories = ["devtools.timeline", "disabled-by-default-devtools.timeline", "toplevel"];
    await this.call("Tracing.start", { traceConfig: { includedCategories } }, undefined);
    await pause(1000 * seconds);
    await this.call("Tracing.end", {}, undefined);
    await done;
    return this.traced;
  }
}

/** How long the main thread of the page worked from each animation frame to the next. */
function framesOf(events) {
  const counts = new Map(); // of animation frames, by thread
  const thread = (event) => `${event.pid}/${event.tid}`;
  const starts = events.filter((event) => event.name === "FireAnimationFrame" && event.ph === "X");
  for (const event of starts) counts.set(thread(event), (counts.get(thread(event)) ?? 0) + 1);
  const [busiest] = [...counts].sort((a, b) => b[1] - a[1])[0] ?? [""];
  const begins = starts.filter((event) => thread(event) === busiest).map((event) => event.ts).sort((a, b) => a - b);
  const sums = (name, time) => {
    const busy = new Array(Math.max(0, begins.length - 1)).fill(0);
    const tasks = events.filter((event) => event.name === name && event.ph === "X" && thread(event) === busiest)
      .sort((a, b) => a.ts - b.ts);
    let frame = 0;
    for (const task of tasks) {
      // A task belongs to the frame in which it ends: the task of an animation frame begins before its callback.
      while (frame < busy.length && task.ts + task.dur > begins[frame + 1]) ++frame;
      if (frame < busy.length && task.ts + task.dur >= begins[0]) busy[frame] += time(task) / 1000;
    }
    return busy;
  };
  const wall = sums("RunTask", (task) => task.dur); // includes the time for which other programs had the core
  const commits = sums("Commit", (task) => task.dur); // and the wait for the process that draws
  const cpu = sums("RunTask", (task) => task.tdur ?? task.dur);
  const summary = (times) => {
    const sorted = [...times].sort((a, b) => a - b);
    const at = (share) => Number((sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN).toFixed(2));
    return { p50: at(0.5), p95: at(0.95), p99: at(0.99), most: at(1) };
  };
  const own = wall.map((time, i) => time - commits[i]);
  return { frames: wall.length, wall_ms: summary(wall), without_commit_ms: summary(own), cpu_ms: summary(cpu) };
}

async function open() {
  const page = new Page();
  const { targetId } = await page.call("Target.createTarget", { url: "about:blank" });
  page.session = (await page.call("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  await page.call("Runtime.enable");
  await page.call("Page.enable");
  await page.call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 600 });
  await page.call("Page.navigate", { url });
  await until(`loading ${url}`, 60000, () =>
    page.value("document.readyState === 'complete' && location.protocol.startsWith('http')"));
  return page;
}

async function carryOut(page, step) {
  const equals = step.indexOf("=");
  const [name, value] = equals < 0 ? [step, ""] : [step.slice(0, equals), step.slice(equals + 1)];
  if (name === "wait") await until(value, kPatience, () => page.value(`!!(${value})`));
  else if (name === "click") await page.click(value);
  else if (name === "print") console.log(JSON.stringify(await page.value(value)));
  else if (name === "press") await page.press(value);
  else if (name === "let") await page.mouse("mouseReleased", ...page.held);
  else if (name === "down" || name === "up")
    await page.call("Input.dispatchKeyEvent", { type: name === "up" ? "keyUp" : "rawKeyDown", key: value, code: value });
  else if (name === "colours") {
    const [, count, selector] = value.match(/^(\d+) (.*)$/);
    await until(step, kPatience, async () => (await page.colours(selector)).length > Number(count));
  } else if (name === "shows") {
    const [, numbers, selector] = value.match(/^(\S*) (.*)$/);
    const wanted = numbers.split(",").map(Number);
    const fits = (colour) => wanted.every((part, i) => Math.abs(part - colour[i]) <= 12);
    await until(step, kPatience, async () =>
      (await page.colours(selector)).filter(fits).reduce((sum, colour) => sum + colour[3], 0) >= 20);
  } else if (name === "frames") console.log(JSON.stringify(framesOf(await page.trace(Number(value)))));
  else if (name === "line") await lines.next();
  else if (name === "shot" || name === "view") {
    if (name === "shot") await page.value("scrollTo(0, 0)"); // what sticks to the window sticks to the top
    const format = value.endsWith(".jpg") ? "jpeg" : "png";
    const { data } = await page.call("Page.captureScreenshot", { captureBeyondViewport: name === "shot", format });
    writeFileSync(value, Buffer.from(data, "base64"));
  } else throw new Error(`unknown step ${step}`);
}

let status = 0;
let page;
try {
  page = await open();
  while (steps.length > 0) {
    await carryOut(page, steps[0]);
    steps.shift();
  }
  if (page.errors.length > 0) throw new Error(`the page threw: ${page.errors.slice(0, 3).join("; ")}`);
} catch (error) {
  console.error(String(error.message ?? error));
  status = 1;
  const view = steps.find((step) => step.startsWith("view="));
  if (page && view) await carryOut(page, view).catch(() => {});
}
const ended = new Promise((done) => chromium.once("exit", done));
chromium.kill("SIGKILL");
await ended;
// Its other processes still write there for a moment.
for (let left = 50; left >= 0; --left) {
  try {
    rmSync(folder, { recursive: true, force: true });
    break;
  } catch (error) {
    if (left === 0) console.error(`${folder} is left: ${error.message}`);
    await pause(100);
  }
}
process.exit(status);
