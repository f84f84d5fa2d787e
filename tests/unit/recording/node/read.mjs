// Reads an MCAP file with the official library and decodes its messages as Foxglove's viewers do. Prints one line of
// JSON for each message, and a last line that describes the file.
//   node read.mjs FILE          a finished file, by its index; all checksums are verified
//   node read.mjs FILE stream   any file, from its beginning to where it ends
import { readFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { decompress } from "fzstd";

const [file, mode] = process.argv.slice(2);
const decompressHandlers = { zstd: (buffer, size) => decompress(buffer, new Uint8Array(Number(size))) };
const schemas = new Map();
const channels = new Map();
const readers = new Map();
const counts = {};

const plain = (_, value) => {
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "number" && !Number.isFinite(value)) return null;
  return ArrayBuffer.isView(value) ? Array.from(value, (one) => plain("", one)) : value;
};

function show(message) {
  const channel = channels.get(message.channelId);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
  const line = { topic: channel.topic, sequence: message.sequence, log_time: Number(message.logTime) };
  const schema = schemas.get(channel.schemaId);
  if (schema) {
    if (!readers.has(schema.id)) {
      const text = new TextDecoder().decode(schema.data);
      readers.set(schema.id, new MessageReader(parse(text, { ros2: true })));
    }
    line.message = readers.get(schema.id).readMessage(message.data);
  } else {
    line.size = message.data.byteLength;
  }
  console.log(JSON.stringify(line, plain));
}

if (mode === "stream") {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(file));
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    else if (record.type === "Channel") channels.set(record.id, record);
    else if (record.type === "Message") show(record);
  }
  console.log(JSON.stringify({ counts, complete: reader.done() }));
} else {
  const handle = await open(file, "r");
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers });
  for (const [id, schema] of reader.schemasById) schemas.set(id, schema);
  for (const [id, channel] of reader.channelsById) channels.set(id, channel);
  for await (const message of reader.readMessages({ validateCrcs: true })) show(message);
  const attachments = {};
  for await (const one of reader.readAttachments({ validateCrcs: true })) {
    attachments[one.name] = new TextDecoder().decode(one.data);
  }
  const metadata = {};
  for await (const one of reader.readMetadata()) metadata[one.name] = Object.fromEntries(one.metadata);
  const statistics = { messages: reader.statistics.messageCount, chunks: reader.statistics.chunkCount };
  console.log(JSON.stringify({ counts, attachments, metadata, statistics }, plain));
  await handle.close();
}
