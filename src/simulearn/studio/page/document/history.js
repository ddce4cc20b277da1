// Undo and redo: documents before and after the current one.

const MOST = 500; // steps that are kept

export function emptyHistory() {
  return { past: [], future: [], merge: null };
}

/** Return the history after an edit of `document`; edits with one merge key are one step. */
export function record(history, document, label, merge = null) {
  if (merge !== null && merge === history.merge) return { ...history, future: [] };
  return { past: [...history.past, { document, label }].slice(-MOST), future: [], merge };
}

/** Return {document, history} one step back, or null at the beginning. */
export function undone(history, document) {
  const before = history.past.at(-1);
  if (!before) return null;
  const future = [...history.future, { document, label: before.label }];
  return { document: before.document, history: { past: history.past.slice(0, -1), future, merge: null } };
}

/** Return {document, history} one step forward, or null at the end. */
export function redone(history, document) {
  const after = history.future.at(-1);
  if (!after) return null;
  const past = [...history.past, { document, label: after.label }];
  return { document: after.document, history: { past, future: history.future.slice(0, -1), merge: null } };
}

/** Return the label of the edit that undo takes back, or null. */
export function undoLabel(history) {
  return history.past.at(-1)?.label ?? null;
}

/** Return the label of the edit that redo does again, or null. */
export function redoLabel(history) {
  return history.future.at(-1)?.label ?? null;
}
