// @ts-check
// Contour maps: the number under the pointer, a point picked by click or keyboard, and limits dragged by their squares.
import { ask, pendingValue } from "./connection.js";
import { STEPS, digits, hit, lines, pointIn } from "./elements.js";

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** @type {Map<string, number[]>} */
const places = new Map(); // of the cursor of each map, as shares of its frame
let dragged = null; // number of the limit
let focused = null; // selector of the part of a map that has the focus, and keeps it when the map is drawn again
const clamp = (share) => Math.min(1, Math.max(0, share));

/** @returns {[number, number]} */
function shareAt(map, event) {
  const [left, top, right, foot] = map.dataset.frame.split(" ").map(Number);
  const point = pointIn(map, event);
  return [(point.x - left) / (right - left), (foot - point.y) / (foot - top)];
}
/** @param {any} map  @param {number[]} share */
function numbersAt(map, [across, up]) {
  const [low, high, least, most] = map.dataset.ends.split(" ").map(Number);
  return [low + across * (high - low), least + up * (most - least)];
}
/** @param {any} map  @param {number[]} share */
function valueAt(map, [across, up]) {
  const rows = JSON.parse(map.dataset.values);
  const x = across * (rows[0].length - 1), y = up * (rows.length - 1);
  const column = Math.min(Math.floor(x), rows[0].length - 2), row = Math.min(Math.floor(y), rows.length - 2);
  const mix = (low, high, share) => (low === null || high === null ? null : low + share * (high - low));
  const along = (values) => mix(values[column], values[column + 1], x - column);
  return mix(along(rows[row]), along(rows[row + 1]), y - row);
}
function showCursor(map, share) {
  const [left, top, right, foot] = map.dataset.frame.split(" ").map(Number), [across, up] = share;
  const cursor = map.querySelector(".cursor"), value = valueAt(map, share), labels = JSON.parse(map.dataset.labels);
  const unit = (index) => (labels[index].match(/\[(.*)\]/) || ["", ""])[1];
  const numbers = [...numbersAt(map, share), value];
  const [x, y, result] = numbers.map((number) => (number === null ? "no result" : digits(number)));
  places.set(map.dataset.pick, share);
  cursor.setAttribute("transform", `translate(${left + across * (right - left)} ${foot - up * (foot - top)})`);
  const named = [x, y, result].map((text, index) => `${labels[index]}: ${text}`);
  cursor.setAttribute("aria-label", `${named.join(", ")}; Enter picks this point`);
  for (const old of cursor.querySelectorAll("text")) old.remove();
  const words = [`${x} ${unit(0)} · ${y} ${unit(1)}`, `${result} ${value === null ? "" : unit(2)}`];
  cursor.append(...lines(words, across > 0.6 ? -10 : 10, up > 0.85 ? 20 : -24, across > 0.6));
}
function moveLimit(handle, event) {
  const name = `map.limits.${handle.dataset.limit}.value`;
  const present = Number(pendingValue(name) ?? handle.getAttribute("aria-valuenow"));
  const text = digits(present + STEPS[event.key] * Number(handle.dataset.step));
  handle.setAttribute("aria-valuenow", text);
  ask("edit", name, text);
}

document.addEventListener("shown", () => {
  for (const map of /** @type {NodeListOf<SVGElement>} */ (document.querySelectorAll("svg[data-pick]")))
    if (!map.querySelector(".cursor[transform]")) showCursor(map, places.get(map.dataset.pick) || [0.5, 0.5]);
  /** @type {HTMLElement | null} */
  const part = focused && document.activeElement === document.body && document.querySelector(focused);
  if (part) part.focus();
});
document.addEventListener("focusin", (event) => {
  const part = hit(event, "[data-limit], .cursor");
  if (!part?.dataset.limit) focused = part && `svg[data-pick="${part.closest("svg").dataset.pick}"] .cursor`;
  else focused = `[data-limit="${part.dataset.limit}"]`;
});
document.addEventListener("pointerdown", (event) => {
  focused = null;
  const handle = hit(event, "[data-limit]");
  if (!handle || document.querySelector("#inputs:disabled")) return;
  dragged = Number(handle.dataset.limit);
  document.documentElement.classList.add("dragging");
  event.preventDefault();
  handle.focus();
});
document.addEventListener("pointermove", (event) => {
  const map = dragged === null ? hit(event, "svg[data-pick]") : document.querySelector("svg[data-pick='map.pick']");
  if (!map) return;
  const share = shareAt(map, event);
  if (dragged !== null) ask("edit", "map.drag", [dragged, ...numbersAt(map, share.map(clamp))]);
  else if (share.every((part) => part === clamp(part))) showCursor(map, share);
}, { passive: true });
for (const end of ["pointerup", "pointercancel"])
  document.addEventListener(end, () => {
    window.setTimeout(() => { dragged = null; }); // after the click that a drag ends with
    document.documentElement.classList.remove("dragging");
  });
document.addEventListener("click", (event) => {
  const map = hit(event, "svg[data-pick]");
  if (!map || dragged !== null || hit(event, "[data-limit]")) return;
  const share = shareAt(map, event);
  if (share.every((part) => part === clamp(part))) ask("edit", map.dataset.pick, numbersAt(map, share));
});
document.addEventListener("keydown", (event) => {
  const cursor = hit(event, ".cursor"), handle = hit(event, "[data-limit]");
  if (handle && STEPS[event.key]) moveLimit(handle, event);
  else if (cursor && ARROWS[event.key]) {
    const map = cursor.closest("svg"), size = event.shiftKey ? 0.1 : 0.02;
    showCursor(map, places.get(map.dataset.pick).map((share, axis) => clamp(share + size * ARROWS[event.key][axis])));
  } else if (cursor && (event.key === "Enter" || event.key === " ")) {
    const map = cursor.closest("svg");
    ask("edit", map.dataset.pick, numbersAt(map, places.get(map.dataset.pick)));
  } else return;
  event.preventDefault();
});
