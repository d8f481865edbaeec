// @ts-check
// Handles of the drawing: what is dragged, or moved by the arrow keys, is the number of an input.
import { pendingValue } from "./connection.js";
import { STEPS, hit, pointIn } from "./elements.js";
import { known, move } from "./fields.js";

let held = null, latest = null;
/** @returns {any} */
const drawing = () => document.querySelector("#press-section svg");

function place(event) {
  const svg = drawing(), [x, y] = svg.dataset.centre.split(" ").map(Number);
  const point = pointIn(svg, event);
  return { x: point.x - x, y: point.y - y, radius: Math.hypot(point.x - x, point.y - y), svg: svg.dataset };
}
const along = ({ x, y }, angle) => x * Math.sin(angle) - y * Math.cos(angle);
const MOVES = {
  ball({ y, svg }) { move("load", held.value + ((y - held.start.y) / (2 * svg.long)) * known("load").high); },
  load(now) {
    const further = along(now, held.angle) - along(held.start, held.angle);
    move("load", held.value + (further / now.svg.long) * known("load").high);
  },
  tilt({ x, y }) { move("tilt", Math.max(0, (Math.atan2(x, -y) * 180) / Math.PI) * known("tilt").factor); },
  border({ radius, svg }) { // each radius in mm by the scale of its own drawing
    const further = radius / svg.scale - held.start.radius / held.start.svg.scale;
    move(held.name, held.value + further * known(held.name).factor);
  },
};
function follow() {
  if (held && latest) MOVES[held.kind](place(latest));
  latest = null;
}
// the drawing keeps its scale while a border is dragged: or it would run away from the pointer
function hold() {
  const svg = drawing();
  if (!svg || !svg.dataset.centre) return;
  const numbers = (text) => text.split(" ").map(Number), [x, y] = numbers(svg.dataset.centre);
  const [, , wide, high] = (svg.box ||= numbers(svg.getAttribute("viewBox")));
  const zoom = held ? svg.dataset.scale / held.start.svg.scale : 1;
  svg.setAttribute("viewBox", [x - zoom * x, y - zoom * y, zoom * wide, zoom * high].join(" "));
}
document.addEventListener("shown", hold);
document.addEventListener("pointerdown", (event) => {
  const handle = hit(event, "[data-drag]");
  if (!handle || document.querySelector("#inputs:disabled")) return;
  const { drag: name, how } = handle.dataset;
  const angle = (known("tilt").value / known("tilt").factor) * (Math.PI / 180);
  const start = { ...place(event), svg: { ...drawing().dataset } };
  held = { name, angle, kind: how === "arrow" ? name : how, start, value: known(name).value };
  document.documentElement.classList.add("dragging");
  event.preventDefault();
  handle.focus();
});
document.addEventListener("pointermove", (event) => {
  if (!held) return;
  if (!latest) requestAnimationFrame(follow);
  latest = event;
});
for (const end of ["pointerup", "pointercancel"])
  document.addEventListener(end, () => {
    follow();
    held = null;
    document.documentElement.classList.remove("dragging");
    hold();
  });
document.addEventListener("keydown", (event) => {
  const handle = hit(event, "[data-drag]");
  const steps = STEPS[event.key];
  if (!handle || !steps) return;
  const { drag: name } = handle.dataset, { value, step } = known(name), pending = Number(pendingValue(name) ?? value);
  move(name, (Number.isNaN(pending) ? value : pending) + steps * step); // quick keys add up before they are answered
  event.preventDefault();
});
