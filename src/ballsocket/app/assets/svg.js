// Parts of SVG pictures, and the pointer in their coordinates.
const SVG = "http://www.w3.org/2000/svg";
export function part(tag, attributes = {}, words = "") {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.textContent = words;
  return node;
}
/** Return lines of text, the first at x and y; they end there if `end` is true. */
export const lines = (words, x, y, end) => words.map((line, row) =>
  part("text", { x, y: y + 15 * row, "text-anchor": end ? "end" : "start" }, line));
export const pointIn = (picture, event) =>
  new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse());
export const digits = (value, count = 4) => String(Number(value.toPrecision(count)));
