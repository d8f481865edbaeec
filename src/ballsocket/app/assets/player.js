// @ts-check
// A cycle that is played: one instant of it in all charts, in the numbers and on the bore.
import { ask } from "./connection.js";
import { digits, part } from "./elements.js";
import { showFrame } from "./viewer.js";

const DURATION = 5000; // ms that a cycle takes here

function marker(chart) {
  const line = part("line", { class: "cursor" }), spot = part("circle", { class: "spot", r: 4.5 });
  chart.append(line, spot);
  return { chart, line, spot, box: chart.dataset.box.split(" ").map(Number) };
}
/** @param {ReturnType<typeof marker>} marker  @param {number} phase  @param {number | null} value */
function move({ chart, line, spot, box: [left, top, right, foot] }, phase, value) {
  const x = left + ((right - left) * phase) / chart.dataset.x;
  const ends = { x1: x, x2: x, y1: top, y2: foot };
  for (const [name, place] of Object.entries(ends)) line.setAttribute(name, String(place));
  const y = value === null ? -99 : foot - ((foot - top) * value) / chart.dataset.y;
  for (const [name, place] of Object.entries({ cx: x, cy: y })) spot.setAttribute(name, String(place));
}
function begin(player) {
  const find = (selector) => player.querySelector(selector);
  const bar = find("input[type=range]"), play = find("button.plain"), output = find("output");
  let data, markers, shown, asked, timer = null, instant = 0;
  function show() {
    bar.value = instant;
    data.courses.forEach((course, number) => move(markers[number], data.phase[instant], course.values[instant]));
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
      const charts = player.querySelectorAll(".courses svg[data-box]");
      markers = data.courses.map((course) => marker(charts[course.chart]));
      bar.max = data.phase.length - 1;
    }
    if (!timer && wanted !== asked) [asked, instant] = [wanted, Number(wanted)];
    instant = Math.min(instant, bar.max);
    show();
  };
}
const updates = new Map([...document.querySelectorAll(".player")].map((player) => [player, begin(player)]));
document.addEventListener("shown", () => { for (const update of updates.values()) update(); });
