// Drawings of other programs: their units, and what was mended in them or could be.

/** Units that drawings come in, and their lengths in mm. */
export const UNITS = {
  mm: 1, cm: 10, m: 1000, um: 0.001, in: 25.4, ft: 304.8, pt: 25.4 / 72, px: 25.4 / 96,
};

/** Return [{ unit, size: [width, height] in mm }] for a drawing's size in units of its file.
 *
 * others: units { name, mm } that may not be among the usual ones.
 */
export function sizesBy(size, others = []) {
  const units = { ...UNITS };
  for (const other of others) if (other && other.name !== "unit") units[other.name] ??= other.mm;
  return Object.entries(units).map(([unit, mm]) => ({ unit, size: size.map((x) => x * mm) }));
}

/** Return the height in mm of a drawing that is made so wide, or null where it has no width. */
export function heightFor([width, height], mm) {
  return width > 0 ? (mm * height) / width : null;
}

/** Return all mends of a drawing, done or not: those found now, and those that were found before and
 * are not to be done; in the order in which they were first found.
 *
 * Mends are { code, count, message, places }; each gets `done`.
 */
export function allMends(before, found, without) {
  const now = new Map(found.map((mend) => [mend.code, { ...mend, done: true }]));
  const off = new Set(without);
  const kept = before.flatMap((mend) => {
    const again = now.get(mend.code);
    now.delete(mend.code);
    if (off.has(mend.code)) return [{ ...mend, done: false }];
    return again ? [again] : [];
  });
  return [...kept, ...now.values()];
}

/** Return a list with an entry, or without it. */
export function withEntry(list, entry, on) {
  const others = list.filter((one) => one !== entry);
  return on ? [...others, entry] : others;
}

/** Return a pattern that fits a name and nothing else: * ? and [ stand for themselves. */
export function patternOf(name) {
  return name.replace(/[[*?]/g, "[$&]");
}
