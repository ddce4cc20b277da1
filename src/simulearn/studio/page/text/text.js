// Every word on the page: t("plan.draw") in the language of the view. Each part of the page has its
// strings in a file of its own, English and German side by side.

import { view } from "../store.js";
import { common } from "./common.js";
import { drawing } from "./drawing.js";
import { material } from "./material.js";
import { panels } from "./panels.js";
import { plan } from "./plan.js";
import { print } from "./print.js";
import { repairs } from "./repairs.js";
import { shape } from "./shape.js";
import { surface } from "./surface.js";

export const LANGUAGES = { en: "English", de: "Deutsch" };
const PARTS = { common, drawing, material, panels, plan, print, repairs, shape, surface };

/** Return the string of a key such as "plan.draw", with {name} replaced by values.name. */
export function t(key, values = {}) {
  const [part, name] = key.split(".");
  const string = PARTS[part]?.[view.language]?.[name] ?? PARTS[part]?.en[name] ?? key;
  return string.replace(/\{(\w+)\}/g, (all, word) => values[word] ?? all);
}
