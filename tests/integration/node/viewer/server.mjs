// Serves the page of the viewer, its packages, and the files of one folder, in which viewers read any range of bytes.
// Usage: node server.mjs MODULES LAYOUT FILES; prints its port.
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const [modules, layout, files] = process.argv.slice(2);
const page = join(dirname(fileURLToPath(import.meta.url)), "viewer.html");
const folders = {
  "/studio/": join(modules, "@foxglove/studio-base/assets"),
  "/react/": join(modules, "react/umd"),
  "/react-dom/": join(modules, "react-dom/umd"),
  "/files/": files,
};
const types = { ".js": "text/javascript", ".html": "text/html", ".wasm": "application/wasm", ".json": "application/json" };

function fileOf(path) {
  if (path === "/") return page;
  if (path === "/layout.json") return layout;
  const folder = Object.keys(folders).find((name) => path.startsWith(name));
  return folder && join(folders[folder], normalize(path.slice(folder.length)));
}

const server = createServer((request, response) => {
  const file = fileOf(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
  let size = 0;
  try {
    size = statSync(file).size;
  } catch {
    return response.writeHead(404).end();
  }
  const headers = { "content-type": types[extname(file)] ?? "application/octet-stream", "accept-ranges": "bytes" };
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? "");
  const start = range ? Number(range[1]) : 0;
  const end = range?.[2] ? Math.min(Number(range[2]), size - 1) : size - 1;
  if (range) headers["content-range"] = `bytes ${start}-${end}/${size}`;
  response.writeHead(range ? 206 : 200, { ...headers, "content-length": end - start + 1 });
  createReadStream(file, { start, end }).pipe(response);
});
server.listen(0, "127.0.0.1", () => console.log(`port ${server.address().port}`));
