// The words of the page: every string in every language, with the same values in it.

import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import test from "node:test";

const PAGE = new URL("../../../src/simulearn/studio/page/", import.meta.url);
const SERVER_SAYS = /^design_/; // the server has English descriptions of its library
const PARTS = ["common", "drawing", "material", "panels", "plan", "print", "repairs", "shape"];

async function strings(part) {
  return (await import(new URL(`text/${part}.js`, PAGE)))[part];
}

const NAMED = new RegExp(`"(${PARTS.join("|")})\\.(\\w+)"`, "g");

const values = (text) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort().join();

for (const part of PARTS) {
  test(`${part}: German has the strings of English, with the same values`, async () => {
    const { en, de } = await strings(part);
    const names = (language) => Object.keys(language).filter((name) => !SERVER_SAYS.test(name)).sort();
    assert.deepEqual(names(de), names(en));
    for (const name of names(en)) assert.equal(values(de[name]), values(en[name]), name);
  });
}

test("every string that the page names is there", async () => {
  const missing = [];
  for (const name of await readdir(PAGE, { recursive: true })) {
    if (!name.endsWith(".js") || name.startsWith("text/")) continue;
    const source = await readFile(new URL(name, PAGE), "utf8");
    for (const [, part, key] of source.matchAll(NAMED)) {
      const { en } = await strings(part);
      if (!(key in en)) missing.push(`${name}: ${part}.${key}`);
    }
  }
  assert.deepEqual(missing, []);
});
