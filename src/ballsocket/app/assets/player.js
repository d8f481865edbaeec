// @ts-check
// A cycle that is played: one instant of it in all charts, in the numbers and on the bore.
import { chartOf, placeIn } from "./charts.js";
import { ask } from "./connection.js";
import { digits, part } from "./elements.js";
import { showFrame } from "./viewer.js";

const DURATION = 5000; // ms that a cycle takes here

/** Mark a point of a chart. */
function mark(svg, phase, value) {
  const { x, y, top, foot } = placeIn(svg, phase, value);
  svg.append(part("line", { class: "cursor", x1: x, x2: x, y1: top, y2: foot }));
  if (value !== null) svg.append(part("circle", { class: "spot", cx: x, cy: y, r: 4.5 }));
}
function begin(player) {
  const find = (selector) => player.querySelector(selector);
  const bar = find("input[type=range]"), play = find(".transport button"), output = find("output");
  let pictures = [], count = 0, asked, timer = null, instant = 0;
  function show() {
    let phase = 0, atRim = false;
    const words = pictures.flatMap((svg) => {
      const { curves, y: unit, flagged } = chartOf(svg);
      for (const old of svg.querySelectorAll(".cursor, .spot")) old.remove();
      phase = curves[0].x[instant];
      atRim ||= flagged.some(([low, high]) => low <= phase && phase <= high);
      return curves.map(({ name, y }) => {
        mark(svg, phase, y[instant]);
        return `${name} ${y[instant] === null ? "–" : digits(y[instant])} ${name.endsWith(unit) ? "" : unit}`.trim();
      });
    });
    bar.value = instant;
    output.textContent = `${phase.toFixed(1)} % of the cycle: ${words.join(", ")}${atRim ? "; ✗ rim contact" : ""}`;
    output.classList.toggle("no", atRim);
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
      const steps = Math.max(0, Math.floor(((now - start) / DURATION) * count));
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
    const wanted = find("[data-at]").textContent;
    pictures = [...player.querySelectorAll(".courses .chart svg[data-chart]")];
    find(".transport").hidden = !pictures.length;
    if (!pictures.length || !find(".viewer")) return;
    count = chartOf(pictures[0]).curves[0].x.length;
    bar.max = count - 1;
    if (!timer && wanted !== asked) [asked, instant] = [wanted, Number(wanted)];
    instant = Math.min(instant, bar.max);
    show();
  };
}
const update = begin(document.querySelector(".player"));
for (const event of ["shown", "zoomed"]) document.addEventListener(event, update);
