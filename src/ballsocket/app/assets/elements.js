// @ts-check
// Elements of the page and parts of SVG pictures, text that is typed, and the pointer in coordinates of a picture.
const SVG = "http://www.w3.org/2000/svg";
/** Steps of a handle by the key that moves it. */
export const STEPS = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 };
/** @param {string} tag  @param {Record<string, any>} attributes  @param {(string | Node)[]} content  @returns {any} */
export function element(tag, attributes = {}, ...content) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...content);
  return node;
}
/** @param {string} tag  @param {Record<string, any>} attributes */
export function part(tag, attributes = {}, words = "") {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.textContent = words;
  return node;
}
/** Return the elements of HTML, in which SVG may stand. @param {string} html  @returns {any} */
export const parsed = (html) => document.createRange().createContextualFragment(html);
/** Draw a short piece of a line of a colour with dashes. @param {string[]} line */
export function swatch([colour, dash]) {
  const svg = part("svg", { class: "swatch", viewBox: "0 0 32 8", "aria-hidden": "true" });
  svg.append(part("path", { d: "M0 4H32", stroke: colour, "stroke-width": 2, "stroke-dasharray": dash }));
  return svg;
}
/** Colours (red, green, blue) from low to high in even steps. */
export const HEAT = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
/** Return the colour of a value from 0 to 1. @param {number} share */
export function heat(share) {
  const place = 4 * Math.min(1, Math.max(0, share)), low = Math.min(3, Math.floor(place));
  return `rgb(${HEAT[low].map((part, index) => Math.round(part + (place - low) * (HEAT[low + 1][index] - part)))})`;
}
const NEWS = 6000; // ms for which a sentence is shown
let news = 0;
/** Show a sentence for some seconds. @param {string} words */
export function tell(words) {
  const place = document.getElementById("news");
  place.textContent = words;
  clearTimeout(news);
  news = setTimeout(() => { place.textContent = ""; }, NEWS);
}
/** Return lines of text, the first at x and y; they end there if `end` is true. @param {string[]} words */
export const lines = (words, x, y, end) => words.map((line, row) =>
  part("text", { x, y: y + 15 * row, "text-anchor": end ? "end" : "start" }, line));
/** @param {SVGGraphicsElement} picture */
export const pointIn = (picture, event) =>
  new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse());
/** Return the nearest element at an event or around it that fits a selector. @returns {any} */
export const hit = (event, selector) => /** @type {Element} */ (event.target).closest?.(selector);
export const digits = (value, count = 4) => String(Number(value.toPrecision(count)));
/** Mark a box with text that nobody has confirmed; confirm it once, also if it is the text before the typing. */
export function confirmTyped(box, confirm) {
  const once = () => {
    if (!box.dataset.typing) return;
    delete box.dataset.typing;
    confirm();
  };
  box.addEventListener("input", () => { box.dataset.typing = "yes"; });
  for (const event of ["change", "blur"]) box.addEventListener(event, once);
  box.addEventListener("keydown", (event) => { if (event.key === "Enter" && box.matches("input")) once(); });
}
