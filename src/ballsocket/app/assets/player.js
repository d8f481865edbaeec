// @ts-check
// A cycle that is played: one instant of it in all charts, in the numbers and on the bore.
import { placeIn } from "./charts.js";
import { ask } from "./connection.js";
import { digits, part } from "./elements.js";
import { showFrame } from "./viewer.js";

const DURATION = 5000; // ms that a cycle takes here

/** Mark a point of a chart, in place of the marks before it for the first `course` of the chart. */
function mark(svg, phase, value, isFirst) {
  const { x, y, top, foot } = placeIn(svg, phase, value);
  if (isFirst) for (const old of svg.querySelectorAll(".cursor, .spot")) old.remove();
  svg.append(part("line", { class: "cursor", x1: x, x2: x, y1: top, y2: foot }));
  if (value !== null) svg.append(part("circle", { class: "spot", cx: x, cy: y, r: 4.5 }));
}
function begin(player) {
  const find = (selector) => player.querySelector(selector);
  const bar = find("input[type=range]"), play = find("button.plain"), output = find("output");
  let data, shown, asked, timer = null, instant = 0;
  function show() {
    bar.value = instant;
    const pictures = player.querySelectorAll(".courses .chart svg[data-chart]");
    data.courses.forEach(({ chart, values }, number) =>
      mark(pictures[chart], data.phase[instant], values[instant], data.courses[number - 1]?.chart !== chart));
    const value = (course) => (course.values[instant] === null ? "–" : digits(course.values[instant]));
    const words = data.courses.map((course) => `${course.name} ${value(course)} ${course.unit}`.trim());
    const rim = data.rim[instant] ? "; ✗ rim contact" : "";
    output.textContent = `${data.phase[instant].toFixed(1)} % of the cycle: ${words.join(", ")}${rim}`;
    output.classList.toggle("no", data.rim[instant]);
    bar.setAttribute("aria-valuetext", output.textContent);
    showFrame(find(".viewer"), instant);
  }
  function halt() {
    cancelAnimationFrame(timer);
    timer = null;
    play.textContent = "▶ Play";
    ask("edit", "gait.instant", instant);
  }
  play.addEventListener("click", () => {
    if (timer) { halt(); return; }
    play.textContent = "❚❚ Pause";
    const start = performance.now(), first = instant;
    timer = requestAnimationFrame(function step(now) {
      const count = data.phase.length, steps = Math.max(0, Math.floor(((now - start) / DURATION) * count));
      const next = (first + steps) % count;
      timer = requestAnimationFrame(step);
      if (next === instant) return;
      instant = next;
      show();
    });
  });
  bar.addEventListener("input", () => { if (timer) halt(); instant = Number(bar.value); show(); });
  bar.addEventListener("change", () => ask("edit", "gait.instant", instant));
  return () => {
    const source = find("[data-player]"), wanted = find("[data-at]").textContent;
    find(".transport").hidden = !source;
    if (!source || !find(".viewer")) return;
    if (source !== shown) {
      [shown, data] = [source, JSON.parse(source.dataset.player)];
      bar.max = data.phase.length - 1;
    }
    if (!timer && wanted !== asked) [asked, instant] = [wanted, Number(wanted)];
    instant = Math.min(instant, bar.max);
    show();
  };
}
const updates = new Map([...document.querySelectorAll(".player")].map((player) => [player, begin(player)]));
for (const event of ["shown", "zoomed"])
  document.addEventListener(event, () => { for (const update of updates.values()) update(); });
