// Numbers as people write and read them.

const COMMA = new Set(["de"]); // languages with a decimal comma

/** Return a number with at most `digits` decimals, as the language writes it, to be read. */
export function formatNumber(value, language = "en", digits = 1) {
  return Number.isFinite(value) ? editableNumber(value, language, digits).replace("-", "−") : "–";
}

/** Return a number as text for a field, with a minus that the keyboard has. */
export function editableNumber(value, language = "en", digits = 3) {
  const text = String(Number(value.toFixed(digits)) || 0); // no minus before a zero
  return COMMA.has(language) ? text.replace(".", ",") : text; // Intl takes a hundred times as long
}

/** Return the number of a text with a point or a comma and perhaps a unit, or null if it is none. */
export function parseNumber(text) {
  const match = /^\s*([+\-−–]?)\s*(\d+(?:[.,]\d*)?|[.,]\d+)\s*(?:mm|%|°)?\s*$/.exec(text);
  if (!match) return null;
  const size = Number(match[2].replace(",", "."));
  return match[1] === "" || match[1] === "+" ? size : -size;
}
