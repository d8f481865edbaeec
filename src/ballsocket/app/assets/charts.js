// @ts-check
// Charts, drawn from their numbers, and the point of a curve under the pointer.
import { digits, lines, part, pointIn } from "./elements.js";

const LEFT = 58, RIGHT = 12, TOP = 10, FOOT = 44, THICK = 2, THIN = 1, NEAR = 18;
/**
 * @typedef {{name: string, colour: string, dash: string, x: (number | null)[], y: (number | null)[],
 *   trusted: number | number[], mark: number[] | null, band: number[][] | null}} Curve
 * @typedef {{label: string, x: string, y: string, start: number, ends: number[], size: number[], flagged: number[][],
 *   curves: Curve[]}} Chart
 */

/** Return the multiples of a round step between two ends. @type {(start: number, end: number, most: number) => number[]} */
function ticks(start, end, most) {
  const wide = end - start, scale = 10 ** Math.floor(Math.log10(wide / most));
  const step = scale * [1, 2, 2.5, 5, 10].find((factor) => factor * scale * most >= wide * (1 - 1e-9));
  const first = Math.ceil(start / step - 1e-9), last = Math.floor((end / step) * (1 + 1e-9));
  return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step);
}
/** Join points by lines, with gaps where a number is missing. @param {[number, number][]} points */
function pathOf(points) {
  let pen = "M";
  return points.map(([x, y]) => {
    const words = Number.isNaN(x + y) ? "" : `${pen}${x.toFixed(1)},${y.toFixed(1)}`;
    pen = words ? "L" : "M";
    return words;
  }).join("");
}
/** @param {Chart} data */
function draw({ label, x, y, start, ends, size: [wide, high], flagged, curves }) {
  const right = wide - RIGHT, foot = high - FOOT, middle = (TOP + foot) / 2;
  const across = (value) => (value === null ? NaN : LEFT + ((right - LEFT) * (value - start)) / (ends[0] - start));
  const up = (value) => (value === null ? NaN : foot - ((foot - TOP) * value) / ends[1]);
  const svg = part("svg", { class: "picture", viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": label });
  const box = `${LEFT} ${TOP} ${right} ${foot}`;
  Object.assign(svg.dataset, { box, x: ends[0], y: ends[1], across: x, up: y });
  const frame = { x: LEFT, y: TOP, width: right - LEFT, height: foot - TOP };
  const area = part("svg", { ...frame, viewBox: Object.values(frame).join(" ") });
  const line = (x1, y1, x2, y2, kind) => svg.append(part("line", { class: kind, x1, y1, x2, y2 }));
  const text = (words, x, y, anchor, more) => svg.append(part("text", { x, y, "text-anchor": anchor, ...more }, words));
  for (const [low, top] of flagged) {
    const width = Math.max(across(top) - across(low), 1);
    area.append(part("rect", { class: "flagged", x: across(low), y: TOP, width, height: foot - TOP }));
  }
  for (const value of ticks(start, ends[0], 6)) {
    line(across(value), TOP, across(value), foot, "grid");
    text(digits(value), across(value), foot + 16, "middle", { class: "tick" });
  }
  for (const value of ticks(0, ends[1], Math.max(2, Math.round((foot - TOP) / 40)))) {
    line(LEFT, up(value), right, up(value), "grid");
    text(digits(value), LEFT - 6, up(value) + 4, "end", { class: "tick" });
  }
  line(LEFT, foot, right, foot, "axis");
  line(LEFT, TOP, LEFT, foot, "axis");
  text(x, (LEFT + right) / 2, foot + FOOT - 8, "middle", { class: "label" });
  text(y, 14, middle, "middle", { class: "label", transform: `rotate(-90 14 ${middle})` });
  for (const curve of curves) {
    const trusted = (index) => (Array.isArray(curve.trusted) ? curve.trusted[index] : curve.trusted);
    /** @type {(ys: (number | null)[]) => [number, number][]} */
    const points = (ys) => ys.map((value, index) => [across(curve.x[index]), up(value)]);
    const stroke = { fill: "none", stroke: curve.colour, "stroke-dasharray": curve.dash, "data-name": curve.name,
      class: curve.dash && "other" };
    if (curve.band) {
      const outline = `${pathOf([...points(curve.band[0]), ...points(curve.band[1]).reverse()])}Z`;
      area.append(part("path", { d: outline, fill: curve.colour, opacity: 0.2 }));
    }
    const thick = pathOf(points(curve.y.map((value, index) => (trusted(index) ? value : null))));
    const thin = curve.y.every((value, index) => trusted(index)) ? "" : pathOf(points(curve.y));
    for (const [d, width] of [[thick, THICK], [thin, THIN]])
      if (d) area.append(part("path", { d, "stroke-width": width, ...stroke }));
    if (curve.mark)
      area.append(part("circle", { cx: across(curve.mark[0]), cy: up(curve.mark[1]), r: 4, fill: curve.colour,
        class: curve.dash && "other" }));
  }
  svg.append(area);
  return svg;
}
/** Draw the charts in an element that was filled. @param {Element} element */
export function drawCharts(element) {
  for (const place of /** @type {NodeListOf<HTMLElement>} */ (element.querySelectorAll("[data-chart]")))
    place.replaceChildren(draw(JSON.parse(place.dataset.chart)));
}

/** @param {SVGElement} chart  @param {DOMPoint} place */
function nearest(chart, place) {
  const { start, ends, curves } = JSON.parse(chart.parentElement.dataset.chart);
  const [left, top, right, foot] = chart.dataset.box.split(" ").map(Number);
  let best = null;
  for (const { name, x: xs, y: ys } of curves)
    xs.forEach((value, index) => {
      const x = left + ((right - left) * (value - start)) / (ends[0] - start), y = foot - ((foot - top) * ys[index]) / ends[1];
      const far = ys[index] === null ? NEAR : Math.hypot(x - place.x, y - place.y);
      if (far < (best?.far ?? NEAR)) best = { far, x, y, name, numbers: [value, ys[index]] };
    });
  return best;
}
function over(event) {
  for (const old of document.querySelectorAll(".tip")) old.remove();
  const path = event.composedPath();
  const chart = /** @type {any} */ (path.find((one) => /** @type {any} */ (one).dataset?.box));
  const found = chart && nearest(chart, pointIn(chart, event));
  if (!found) return;
  const tip = part("g", { class: "tip" }), end = found.x > 240, { across, up } = chart.dataset;
  const words = [found.name, `${across}: ${digits(found.numbers[0], 3)}`, `${up}: ${digits(found.numbers[1], 3)}`];
  tip.append(part("circle", { cx: found.x, cy: found.y, r: 3.5 }));
  tip.append(...lines(words, found.x + (end ? -8 : 8), Math.max(24, found.y - 34), end));
  chart.append(tip);
}
document.addEventListener("pointermove", over, { passive: true });
