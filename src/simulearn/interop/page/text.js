// The words of the page, in place of the studio's text.js: those of the shape and a few of its own.

import { view } from "/page/store.js";
import { shape } from "/page/text/shape.js";
import { share } from "./words.js";

const PARTS = { shape, share };

/** Return the string of a key such as "shape.play", with {name} replaced by values.name. */
export function t(key, values = {}) {
  const [part, name] = key.split(".");
  const string = PARTS[part]?.[view.language]?.[name] ?? PARTS[part]?.en[name] ?? key;
  return string.replace(/\{(\w+)\}/g, (all, word) => values[word] ?? all);
}
