// @ts-check
// What lies under the pointer in a chart: the nearest point of a curve, with its numbers.
import { digits, lines, part, pointIn } from "./svg.js";

/** @param {any} curve  @returns {[number, number][]} */
function points(curve) {
  const pairs = curve.getAttribute("d").matchAll(/([-\d.]+),([-\d.]+)/g);
  return (curve.points ??= [...pairs].map((pair) => [+pair[1], +pair[2]]));
}
function nearest(chart, x, y) {
  let best = null;
  for (const curve of chart.querySelectorAll("path[data-name]"))
    for (const [px, py] of points(curve)) {
      const far = Math.hypot(px - x, py - y);
      if (far < 18 && (!best || far < best.far)) best = { far, x: px, y: py, name: curve.getAttribute("data-name") };
    }
  return best;
}
function tipLines(chart, found) {
  const [left, top, right, foot] = chart.dataset.box.split(" ").map(Number);
  const across = ((found.x - left) / (right - left)) * chart.dataset.x;
  const up = ((foot - found.y) / (foot - top)) * chart.dataset.y;
  return [found.name, `${chart.dataset.across}: ${digits(across, 3)}`, `${chart.dataset.up}: ${digits(up, 3)}`];
}
function over(event) {
  for (const old of document.querySelectorAll(".tip")) old.remove();
  const path = event.composedPath();
  const chart = /** @type {any} */ (path.find((one) => /** @type {any} */ (one).dataset?.box));
  if (!chart) return;
  const place = pointIn(chart, event);
  const found = nearest(chart, place.x, place.y);
  if (!found) return;
  const tip = part("g", { class: "tip" }), end = found.x > 240;
  tip.append(part("circle", { cx: found.x, cy: found.y, r: 3.5 }));
  tip.append(...lines(tipLines(chart, found), found.x + (end ? -8 : 8), Math.max(24, found.y - 34), end));
  chart.append(tip);
}
document.addEventListener("pointermove", over, { passive: true });
