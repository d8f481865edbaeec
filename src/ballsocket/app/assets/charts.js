// @ts-check
// Charts, drawn from their numbers: the point of a curve under the pointer, a zoom along x, and a copy as CSV.
import { digits, element, hit, lines, part, pointIn, swatch, tell } from "./elements.js";

const LEFT = 58, RIGHT = 12, TOP = 10, FOOT = 44, THICK = 2, THIN = 1, NEAR = 18, DRAGGED = 8;
/**
 * @typedef {{name: string, line: string[], x: (number | null)[], y: (number | null)[],
 *   trusted: number | number[], mark: number[] | null, band: number[][] | null}} Curve
 * @typedef {{key: string, label: string, x: string, y: string, start: number, ends: number[], size: number[], flagged: number[][],
 *   caption: string[], curves: Curve[]}} Chart
 * @typedef {{chart: Chart, x: number[], y: number[], across: (x: number) => number, up: (y: number) => number}} Drawn
 */
/** @type {WeakMap<Element, Drawn>} */
const drawn = new WeakMap(); // by the picture
/** @type {Map<string, number[]>} */
const windows = new Map(); // ends of x that were chosen, by the chart's place and axes: they outlive an answer

/**
 * Return the multiples of a round step between two ends.
 * @type {(start: number, end: number, most: number) => number[]}
 */
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
/** Return the ends of both axes: all of the chart, or a window of x with the values in it. @param {Chart} chart */
function endsOf(chart) {
  const x = windows.get(chart.key), whole = [0, chart.ends[1]];
  if (!x) return { x: [chart.start, chart.ends[0]], y: whole };
  const inside = chart.curves.flatMap((curve) =>
    curve.y.filter((value, index) => value !== null && curve.x[index] >= x[0] && curve.x[index] <= x[1]));
  if (!inside.length) return { x, y: whole };
  const low = Math.min(...inside), high = Math.max(...inside);
  const margin = 0.06 * (high - low || Math.abs(high) || whole[1]);
  return { x, y: [low - margin, high + margin] };
}
/** @param {Chart} chart */
function draw(chart) {
  const { label, size: [wide, high], flagged, curves } = chart, ends = endsOf(chart);
  const right = wide - RIGHT, foot = high - FOOT, middle = (TOP + foot) / 2;
  /** @type {(value: number | null, ends: number[], from: number, to: number) => number} */
  const place = (value, [low, top], from, to) =>
    (value === null ? NaN : from + ((to - from) * (value - low)) / (top - low));
  const across = (value) => place(value, ends.x, LEFT, right), up = (value) => place(value, ends.y, foot, TOP);
  const svg = part("svg", { class: "picture", viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": label });
  svg.dataset.chart = "";
  drawn.set(svg, { chart, ...ends, across, up });
  const frame = { x: LEFT, y: TOP, width: right - LEFT, height: foot - TOP };
  const area = part("svg", { ...frame, viewBox: Object.values(frame).join(" ") });
  const line = (x1, y1, x2, y2, kind) => svg.append(part("line", { class: kind, x1, y1, x2, y2 }));
  const text = (words, x, y, anchor, more) => svg.append(part("text", { x, y, "text-anchor": anchor, ...more }, words));
  for (const [low, top] of flagged) {
    const width = Math.max(across(top) - across(low), 1);
    area.append(part("rect", { class: "flagged", x: across(low), y: TOP, width, height: foot - TOP }));
  }
  for (const value of ticks(ends.x[0], ends.x[1], 6)) {
    line(across(value), TOP, across(value), foot, "grid");
    text(digits(value), across(value), foot + 16, "middle", { class: "tick" });
  }
  for (const value of ticks(ends.y[0], ends.y[1], Math.max(2, Math.round((foot - TOP) / 40)))) {
    line(LEFT, up(value), right, up(value), "grid");
    text(digits(value), LEFT - 6, up(value) + 4, "end", { class: "tick" });
  }
  line(LEFT, foot, right, foot, "axis");
  line(LEFT, TOP, LEFT, foot, "axis");
  text(chart.x, (LEFT + right) / 2, foot + FOOT - 8, "middle", { class: "label" });
  text(chart.y, 14, middle, "middle", { class: "label", transform: `rotate(-90 14 ${middle})` });
  for (const curve of curves) {
    const trusted = (index) => (Array.isArray(curve.trusted) ? curve.trusted[index] : curve.trusted);
    const [colour, dash] = curve.line, kind = dash && "other";
    /** @type {(ys: (number | null)[]) => [number, number][]} */
    const points = (ys) => ys.map((value, index) => [across(curve.x[index]), up(value)]);
    const stroke = { fill: "none", stroke: colour, "stroke-dasharray": dash, "data-name": curve.name, class: kind };
    if (curve.band) {
      const outline = `${pathOf([...points(curve.band[0]), ...points(curve.band[1]).reverse()])}Z`;
      area.append(part("path", { d: outline, fill: colour, opacity: 0.2 }));
    }
    const thick = pathOf(points(curve.y.map((value, index) => (trusted(index) ? value : null))));
    const thin = curve.y.every((value, index) => trusted(index)) ? "" : pathOf(points(curve.y));
    for (const [d, width] of [[thick, THICK], [thin, THIN]])
      if (d) area.append(part("path", { d, "stroke-width": width, ...stroke }));
    if (curve.mark)
      area.append(part("circle",
        { cx: across(curve.mark[0]), cy: up(curve.mark[1]), r: 4, fill: colour, class: kind }));
  }
  svg.append(area);
  return svg;
}
/**
 * Draw charts beside each other, with the names of curves and further words below.
 * @param {any} block  @param {Element} place
 */
export function charts({ charts: all, legend }, place) {
  const figures = all.map((chart) => figure({ ...chart, key: `${place.id} ${chart.x} ${chart.y}` }));
  const row = element("div", { class: all.length > 1 ? "pair" : "" }, ...figures);
  if (!legend) return row;
  const names = all[0].curves.map(({ name, line }) => element("span", { class: "key" }, swatch(line), name));
  const thin = all.some(({ curves }) => curves.some(({ trusted }) => [trusted].flat().includes(0)));
  const words = [...legend, ...(thin ? ["thin: the model is not valid there"] : [])]
    .map((text) => element("span", { class: "key" }, text));
  return element("div", {}, row, element("p", { class: "legend" }, ...names, ...words));
}
/** @param {Chart} chart */
function figure(chart) {
  const [words, red] = chart.caption, { key } = chart;
  const caption = element("figcaption", {}, words ?? "");
  if (!chart.curves.length) return element("figure", { class: "quiet" }, caption, draw(chart));
  if (red) caption.append(element("b", { class: "no" }, red));
  const node = element("figure", { class: "chart" }, ...(words || red ? [caption] : []), draw(chart));
  const button = (text, label) => element("button", { type: "button", "aria-label": label }, text);
  const zoom = button("Zoom", `Zoom into ${chart.y}`), all = button("All", `Show all of ${chart.y}`);
  const copy = button("CSV", `Copy ${chart.y} as CSV`);
  /** @param {number[] | null} ends */
  node.show = (ends) => {
    if (ends) windows.set(key, ends);
    else windows.delete(key);
    node.querySelector("svg").replaceWith(draw(chart));
    all.hidden = !windows.has(key);
    document.dispatchEvent(new CustomEvent("zoomed"));
  };
  zoom.addEventListener("click", () => {
    const [low, high] = drawn.get(node.querySelector("svg")).x, quarter = (high - low) / 4;
    node.show([low + quarter, high - quarter]);
  });
  all.addEventListener("click", () => node.show(null));
  all.hidden = !windows.has(key);
  const refuse = () => tell("This browser lets no page copy here: save the numbers of the view as CSV");
  copy.addEventListener("click", () =>
    navigator.clipboard?.writeText(csvOf(chart)).then(() => tell("copied"), refuse) ?? refuse());
  node.append(element("div", { class: "chart-tools" }, zoom, all, copy));
  return node;
}
/** Return all points as CSV; text that a spreadsheet would take for a formula is marked. @param {Chart} chart */
function csvOf({ x, y, curves }) {
  const quoted = (text) => `"${text.replace(/^[=+\-@]/, "'$&").replaceAll('"', '""')}"`;
  const rows = curves.flatMap(({ name, x, y }) => x.map((value, index) => [quoted(name), value, y[index]].join(",")));
  return [["curve", x, y].map(quoted).join(","), ...rows, ""].join("\n");
}
/**
 * Return the picture coordinates of a point of a chart.
 * @param {Element} svg  @param {number | null} x  @param {number | null} y
 */
export function placeIn(svg, x, y) {
  const { across, up } = drawn.get(svg);
  return { x: across(x), y: up(y), top: TOP, foot: up(drawn.get(svg).y[0]) };
}

/** @param {Element} svg */
export const chartOf = (svg) => drawn.get(svg).chart;

/** @param {Drawn} chart  @param {DOMPoint} place */
function nearest({ chart: { curves }, across, up }, place) {
  let best = null;
  for (const { name, x: xs, y: ys } of curves)
    xs.forEach((value, index) => {
      const x = across(value), y = up(ys[index]), far = Number.isNaN(y) ? NEAR : Math.hypot(x - place.x, y - place.y);
      if (far < (best?.far ?? NEAR)) best = { far, x, y, name, numbers: [value, ys[index]] };
    });
  return best;
}
let held = null; // picture and x at which a drag began
function over(event) {
  for (const old of document.querySelectorAll(".tip")) old.remove();
  const svg = held?.svg ?? hit(event, "svg[data-chart]"), data = svg && drawn.get(svg);
  if (!data) return;
  const place = pointIn(svg, event), tip = part("g", { class: "tip" }), found = held ? null : nearest(data, place);
  if (held) {
    const x = Math.min(held.x, place.x), width = Math.abs(place.x - held.x);
    tip.append(part("rect", { class: "chosen", x, width, y: TOP, height: data.up(data.y[0]) - TOP }));
  } else if (found) {
    const end = found.x > 240, [x, y] = found.numbers.map((number) => digits(number, 3));
    const words = [found.name, `${data.chart.x}: ${x}`, `${data.chart.y}: ${y}`];
    tip.append(part("circle", { cx: found.x, cy: found.y, r: 3.5 }));
    tip.append(...lines(words, found.x + (end ? -8 : 8), Math.max(24, found.y - 34), end));
  }
  svg.append(tip);
}
document.addEventListener("pointermove", over, { passive: true });
document.addEventListener("pointerdown", (event) => { // a finger scrolls the page
  const svg = event.pointerType !== "touch" && hit(event, ".chart svg[data-chart]");
  if (!svg) return;
  held = { svg, x: pointIn(svg, event).x };
  event.preventDefault();
});
document.addEventListener("pointerup", (event) => {
  if (!held) return;
  const { svg, x } = held, end = pointIn(svg, event).x, { x: [low, high], across } = drawn.get(svg);
  held = null;
  over(event);
  if (!svg.isConnected || Math.abs(end - x) <= DRAGGED) return;
  const value = (place) => Math.min(high, Math.max(low, low + ((place - LEFT) * (high - low)) / (across(high) - LEFT)));
  svg.closest("figure").show([value(Math.min(x, end)), value(Math.max(x, end))]);
});
document.addEventListener("dblclick", (event) => hit(event, ".chart svg[data-chart]")?.closest("figure").show(null));
