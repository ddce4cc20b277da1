export async function thumbnail() {
  return "data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 160 100'><path d='M20 70 Q80 10 140 70 M20 70 Q80 90 140 70' fill='none' stroke='%231a56db' stroke-width='6'/></svg>";
}
