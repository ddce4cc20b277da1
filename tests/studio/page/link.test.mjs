// A document travels in a link; what is no document is refused, and does not fill the memory.

import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { decode, encode } from "../../../src/simulearn/studio/page/document/link.js";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { seeded, square } from "./support.mjs";

const text = (data) => deflateRawSync(data).toString("base64url");

test("a document comes back as it was, whatever letters its name has", async () => {
  for (const name of ["", "Twist", "Größe \u{1f980} 中文 \u0000\"\\", "é".repeat(200)]) {
    const goals = [{ vertex: ["beam", 1, "end", 2] }];
    const document = { ...square({ actuators: [0.3, -1, 1e-6, 0], goals }), name };
    const link = await encode(document);
    assert.match(link, /^[A-Za-z0-9_-]+$/);
    assert.deepEqual(await decode(link), document);
  }
  assert.deepEqual(await decode(await encode(emptyDocument())), emptyDocument());
});

test("a link of a usual design is short", async () => {
  assert.ok((await encode(square())).length < 400);
});

test("garbage is refused in a sentence", async () => {
  const link = await encode(square());
  const noText = text(Buffer.from([0xff, 0xfe]));
  for (const one of [link.slice(0, -5), link.slice(3), "AAAA", "A", text("{}x"), noText])
    await assert.rejects(decode(one), /The link is damaged or incomplete/, one.slice(0, 20));
  for (const one of ["", "a b", "ü", "a=b", undefined, 7, null])
    await assert.rejects(decode(one), /characters that no link has/);
  await assert.rejects(decode(text("{}")), /schema is missing/);
  await assert.rejects(decode(text("null")), /the document is null/);
  await assert.rejects(decode(text('{"schema": "simulearn.document/1"}')), /the grid is missing/);
  await assert.rejects(decode("A".repeat(2_000_000)), /too long/);
  const random = seeded(5);
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  for (let k = 0; k < 200; k += 1) {
    const one = Array.from({ length: 1 + random() * 60 }, () => letters[Math.floor(random() * 64)]).join("");
    const plain = ({ message }) => /^(The link|The design|the document|schema)/.test(message);
    await assert.rejects(decode(one), plain);
  }
});

test("a link with more than a design can be is refused before it fills the memory", async () => {
  const bomb = text(Buffer.alloc(200_000_000, " "));
  assert.ok(bomb.length < 1_400_000);
  const before = process.memoryUsage();
  let most = 0;
  const watch = setInterval(() => (most = Math.max(most, process.memoryUsage().arrayBuffers)), 1);
  await assert.rejects(decode(bomb), /The design in the link is too large/);
  clearInterval(watch);
  most = Math.max(most, process.memoryUsage().arrayBuffers);
  assert.ok(most - before.arrayBuffers < 30_000_000, `${most - before.arrayBuffers} bytes`);
});

test("lists in lists are refused, not followed", async () => {
  const nested = "[".repeat(400_000) + "]".repeat(400_000);
  const link = text(`{"schema": "simulearn.document/1", "grid": ${nested}}`);
  await assert.rejects(decode(link), ({ message }) => /^the grid is nested too deeply/.test(message));
});
