// Quantities as text in the language of the page: how many digits, which unit.

import { view } from "../store.js";

const formats = new Map(); // language and digits -> Intl.NumberFormat
const MINUTE = 60; // s
const HOUR = 3600; // s

/** Return a number with exactly so many decimals; a dash where there is none. */
export function number(value, digits = 0) {
  if (!Number.isFinite(value)) return "–";
  const key = `${view.language} ${digits}`;
  if (!formats.has(key)) {
    formats.set(key, new Intl.NumberFormat(view.language, {
      minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false,
    }));
  }
  const rounded = Number(value.toFixed(digits)) || 0; // no minus before a zero
  return formats.get(key).format(rounded).replace("-", "−");
}

/** Return a distance in mm without its unit: engines are not sure of hundredths beyond 1 mm. */
export function distance(value) {
  const size = Math.abs(value);
  return number(value, size < 0.995 ? 2 : size < 99.95 ? 1 : 0);
}

/** Return a distance in mm: "0.42 mm", "12.3 mm", "140 mm". */
export const mm = (value) => `${distance(value)} mm`;

/** Return a short time: "5 ms", "1.4 s", "32 s". */
export function seconds(value) {
  if (value < 1) return `${number(1000 * value)} ms`;
  return `${number(value, value < 10 ? 1 : 0)} s`;
}

/** Return a long time: "45 s", "12 min", "3 h 05 min". */
export function clock(value) {
  if (value < MINUTE) return `${number(value)} s`;
  const minutes = Math.round(value / MINUTE);
  if (value < HOUR) return `${number(minutes)} min`;
  return `${number(Math.floor(minutes / 60))} h ${String(minutes % 60).padStart(2, "0")} min`;
}

/** Return a length of filament: "820 mm", "2.31 m". */
export function metres(millimetres) {
  return millimetres < 1000 ? `${number(millimetres)} mm` : `${number(millimetres / 1000, 2)} m`;
}

/** Return a mass: "0.8 g", "12 g". */
export const grams = (value) => `${number(value, value < 10 ? 1 : 0)} g`;

/** Return a part of one as per cent: "25 %". */
export const percent = (value) => `${number(100 * value)} %`;

/** Return a ratio of an actuator with its sign: "+25 %", "0 %". */
export const ratio = (value) => `${value > 0 ? "+" : ""}${percent(value)}`;

/** Return how many times as much one time is as another: "100", "1200", "3.4". */
export function times(value) {
  if (value < 10) return number(value, 1);
  const step = 10 ** Math.max(0, Math.floor(Math.log10(value)) - 1); // two digits mean something
  return number(Math.round(value / step) * step);
}
