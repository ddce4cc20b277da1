// Compressed contents of the page (gzip, base64 in a script element that is no script).

/** Return the contents of the element with this id as a Response. */
export async function unpacked(id) {
  const text = atob(globalThis.document.getElementById(id).textContent);
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
}
