// Colours of values: perceptually uniform maps that people with any colour vision can read, and the
// legend's numbers.

/** Nine colours each, from low to high; between them colours are mixed. Viridis and cividis are those
 * of matplotlib (CC0); "diverging" runs from blue over grey to orange. */
export const MAPS = {
  viridis: [
    "#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
    "#28ae80", "#5ec962", "#addc30", "#fde725",
  ],
  cividis: [
    "#00224e", "#123570", "#3b496c", "#575d6d", "#707173",
    "#8a8678", "#a59c74", "#c3b369", "#fee838",
  ],
  diverging: [
    "#0b4f94", "#3a7dbb", "#79a9d4", "#b5cde2", "#dcdcdc",
    "#eac7a7", "#e29a5c", "#c96a1d", "#964500",
  ],
};

/** What shapes can be coloured by: the map and unit of each, `null` being the colours of the parts. */
export const COLOURINGS = {
  actuator: { map: null, unit: "" },
  stress: { map: "viridis", unit: "MPa" },
  strain: { map: "diverging", unit: "%" },
  height: { map: "viridis", unit: "mm" },
  deviation: { map: "viridis", unit: "mm" },
};

/** Return [red, green, blue] from 0 to 1 of a colour as style sheets write it: #rgb, #rrggbb, rgb(). */
export function parseColour(text) {
  const value = text.trim();
  const short = /^#([\da-f])([\da-f])([\da-f])$/i.exec(value);
  if (short) return short.slice(1).map((digit) => parseInt(digit + digit, 16) / 255);
  const long = /^#([\da-f]{2})([\da-f]{2})([\da-f]{2})$/i.exec(value);
  if (long) return long.slice(1).map((digits) => parseInt(digits, 16) / 255);
  const parts = /^rgba?\(\s*([\d.]+)[\s,]+([\d.]+)[\s,]+([\d.]+)/.exec(value);
  if (parts) return parts.slice(1).map((number) => Number(number) / 255);
  throw new Error(`${JSON.stringify(text)} is not a colour that is known here: #rrggbb or rgb(r, g, b)`);
}

/** Return the colour [r, g, b] of a map at t from 0 to 1. */
export function sample(map, t) {
  const colours = MAPS[map];
  const at = Math.min(1, Math.max(0, t)) * (colours.length - 1);
  const before = Math.min(colours.length - 2, Math.floor(at));
  const [a, b] = [parseColour(colours[before]), parseColour(colours[before + 1])];
  return a.map((x, k) => x + (at - before) * (b[k] - x));
}

/** Return the bytes of a table of n colours (r, g, b, opaque), for a texture. */
export function table(map, n = 256) {
  const bytes = new Uint8Array(4 * n);
  for (let k = 0; k < n; k += 1)
    bytes.set([...sample(map, k / (n - 1)).map((x) => Math.round(255 * x)), 255], 4 * k);
  return bytes;
}

/** Return a range widened to two digits, so that it stays still while a design changes a little. */
export function calmRange([low, high]) {
  const span = Math.max(Math.abs(low), Math.abs(high), high - low);
  if (!(span > 0)) return [0, 1];
  const step = 10 ** Math.floor(Math.log10(span)) / 10;
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const tidy = (x) => Number((x * step).toFixed(digits));
  return [tidy(Math.floor(low / step + 1e-6)), tidy(Math.ceil(high / step - 1e-6))];
}

/** Return the numbers of a legend: n of equal distance, with the decimals that tell them apart. */
export function ticks([low, high], n = 5) {
  const step = (high - low) / (n - 1);
  const digits = Math.min(4, Math.max(0, Math.ceil(-Math.log10(step) + 0.3)));
  return Array.from({ length: n }, (_, k) => ({ at: k / (n - 1), value: low + k * step, digits }));
}
