// Copies of documents in the browser: a reload brings back the document and its undo history.

import assert from "node:assert/strict";
import test, { beforeEach } from "node:test";
import { emptyDocument } from "../../../src/simulearn/studio/page/document/document.js";
import { emptyHistory, record } from "../../../src/simulearn/studio/page/document/history.js";
import { index, readCopy, writeCopy } from "../../../src/simulearn/studio/page/service/copies.js";

/** A storage of so many characters. */
class Storage {
  constructor(room) {
    this.room = room;
    this.items = new Map();
  }

  getItem(key) {
    return this.items.get(key) ?? null;
  }

  setItem(key, text) {
    const others = [...this.items].filter(([other]) => other !== key);
    const used = others.reduce((sum, [other, value]) => sum + other.length + value.length, 0);
    if (used + key.length + text.length > this.room) throw new DOMException("full", "QuotaExceededError");
    this.items.set(key, text);
  }

  removeItem(key) {
    this.items.delete(key);
  }
}

const named = (name) => ({ ...emptyDocument(), name });

function edited(steps) {
  let history = emptyHistory();
  for (let n = 0; n < steps; n += 1) history = record(history, named(`before ${n}`), `edit ${n}`);
  return { revision: 3, saved: false, document: named("now"), history };
}

beforeEach(() => {
  globalThis.localStorage = new Storage(5_000_000);
});

test("a copy is read as it was written, with its history", () => {
  const copy = edited(3);
  assert.ok(writeCopy("a", copy));
  assert.deepEqual(readCopy("a"), copy);
  assert.equal(readCopy("b"), null);
});

test("a damaged copy is none, a damaged history is an empty one", () => {
  writeCopy("a", edited(1));
  const key = [...localStorage.items.keys()].find((name) => name.endsWith(".a"));
  localStorage.setItem(key, localStorage.getItem(key).replace('"past":[{', '"past":[7,{'));
  assert.deepEqual(readCopy("a").history, emptyHistory());
  assert.equal(readCopy("a").document.name, "now");
  localStorage.setItem(key, "{");
  assert.equal(readCopy("a"), null);
});

test("where there is no room, saved copies go first, then the oldest steps", () => {
  globalThis.localStorage = new Storage(6000);
  assert.ok(writeCopy("old", { ...edited(2), saved: true }));
  assert.ok(writeCopy("new", { ...edited(40) }));
  assert.equal(readCopy("old"), null);
  assert.deepEqual(index().map(({ id }) => id), ["new"]);
  const { document, history } = readCopy("new");
  assert.equal(document.name, "now");
  assert.ok(history.past.length < 40);
  assert.equal(history.past.at(-1)?.label ?? "edit 39", "edit 39");
});

test("a browser that keeps nothing says so", () => {
  globalThis.localStorage = new Storage(100);
  assert.equal(writeCopy("a", edited(1)), false);
  Object.defineProperty(globalThis, "localStorage", { configurable: true, writable: true, value: undefined });
  assert.equal(writeCopy("a", edited(1)), false);
  assert.deepEqual(index(), []);
});
