// A document as a short text for the address of a page: JSON, deflated, in base64url.

import { readDocument } from "./document.js";

const MOST = 1_000_000; // bytes of JSON; far beyond any grid that is printed
const MOST_TEXT = 1_400_000; // characters: so many bytes that do not deflate, in base64
const SLICE = 4096; // bytes that are inflated at once, at most a thousandfold

/** Return a document as text. */
export async function encode(document) {
  const bytes = new TextEncoder().encode(JSON.stringify(document));
  const packed = await collect(bytes, new CompressionStream("deflate-raw"), Infinity);
  let text = "";
  for (const byte of packed) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** Return the document of a text from `encode`; throws an Error that says what is wrong. */
export async function decode(text) {
  if (typeof text !== "string" || !/^[A-Za-z0-9_-]+$/.test(text))
    throw new Error("The link does not hold a design: it has characters that no link has.");
  if (text.length > MOST_TEXT) throw new Error("The link is too long to hold a design.");
  let data;
  try {
    const packed = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(packed, (letter) => letter.charCodeAt(0));
    const plain = await collect(bytes, new DecompressionStream("deflate-raw"), MOST);
    data = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(plain));
  } catch (error) {
    if (error instanceof TooLarge) throw new Error("The design in the link is too large.");
    throw new Error("The link is damaged or incomplete; it does not hold a design.");
  }
  return readDocument(data);
}

class TooLarge extends Error {}

/** Return bytes sent through a stream, piece by piece, so that few are in memory at once. */
async function collect(bytes, stream, most) {
  let sent = 0;
  const source = new ReadableStream({
    pull(controller) {
      if (sent >= bytes.length) return controller.close();
      controller.enqueue(bytes.subarray(sent, sent + SLICE));
      sent += SLICE;
    },
  });
  const reader = source.pipeThrough(stream).getReader();
  const parts = [];
  let size = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    size += part.value.length;
    if (size > most) {
      await reader.cancel();
      throw new TooLarge();
    }
    parts.push(part.value);
  }
  const all = new Uint8Array(size);
  let start = 0;
  for (const part of parts) {
    all.set(part, start);
    start += part.length;
  }
  return all;
}
