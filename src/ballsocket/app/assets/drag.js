// Handles of the drawing: what is dragged, or moved by the arrow keys, is the number of an input.
import { pendingValue } from "./connection.js";
import { known, move } from "./fields.js";
import { pointIn } from "./svg.js";

let held = null, latest = null;
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
  border({ radius, svg }) {
    const further = radius - held.start.radius; // a handle that is only touched moves nothing
    move(held.name, held.value + (further / svg.scale) * known(held.name).factor);
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
  const [x, y] = svg.dataset.centre.split(" ").map(Number), [, , wide, high] = (svg.box ||= svg.getAttribute("viewBox").split(" ").map(Number));
  const zoom = held ? svg.dataset.scale / held.start.svg.scale : 1;
  svg.setAttribute("viewBox", [x - zoom * x, y - zoom * y, zoom * wide, zoom * high].join(" "));
}
document.addEventListener("shown", hold);
document.addEventListener("pointerdown", (event) => {
  const handle = event.target.closest?.("[data-drag]");
  if (!handle || document.getElementById("inputs").disabled) return;
  const { drag: name, how } = handle.dataset;
  const angle = (known("tilt").value / known("tilt").factor) * (Math.PI / 180);
  held = { name, angle, kind: how === "arrow" ? name : how, start: { ...place(event), svg: { ...drawing().dataset } }, value: known(name).value };
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
  const handle = event.target.closest?.("[data-drag]");
  const steps = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }[event.key];
  if (!handle || !steps) return;
  const { drag: name } = handle.dataset, { value, step } = known(name), pending = Number(pendingValue(name) ?? value);
  move(name, (Number.isNaN(pending) ? value : pending) + steps * step); // quick keys add up before they are answered
  event.preventDefault();
});
