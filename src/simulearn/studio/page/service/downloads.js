// Files that the browser saves.

import { notify } from "../store.js";
import { t } from "../text/text.js";

/** Have the browser save a file, and say so. */
export function download(blob, name) {
  const link = globalThis.document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // ms; the browser has read it by then
  notify(t("common.downloaded", { file: name }));
}
