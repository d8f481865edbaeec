// @ts-check
// History: the last steps of the undo with what each changed, and what that did to the largest pressure and verdict.
import { listen } from "./connection.js";
import { element } from "./elements.js";
import { isVisit, latest, step } from "./history.js";
import "./page.js"; // which shows a message first

const KEY = "ballsocket.history"; // of the steps in the storage of this window
const KEPT = 20, CHANGES = 2; // number of steps in the list, and of changes in one line
const TEXTS = { // words of an input by its kind; others are in no list
  number: (field) => `${field.text} ${field.unit}`.trim(),
  choice: (field) => new Map(field.options).get(field.value) ?? "",
  segments: (field) => new Map(field.options).get(field.value) ?? "",
  words: (field) => field.value,
  several: (field) => field.value.join(", "),
  rows: (field) => field.value,
  tick: (field) => (field.value ? "yes" : "no"),
};
/** @typedef {{edited: string, inputs: Record<string, [string, string]>, pressure: string, sign: string}} Step */
/** @type {Record<number, Step>} */
let steps = isVisit ? {} : JSON.parse(sessionStorage.getItem(KEY) ?? "{}");
/** @type {Record<string, [string, string]>} */
let inputs = {}; // label and text by name, as they are on the page
const list = document.getElementById("step-list");
const place = /** @type {HTMLDetailsElement} */ (list.parentElement);

/** Say what a step changed, beginning with the input that was edited. @param {Step} one  @param {Step} before */
function changes({ edited, inputs }, before) {
  const changed = Object.keys(inputs).filter((name) => (before.inputs[name] ?? inputs[name])[1] !== inputs[name][1]);
  changed.sort((one, other) => Number(other === edited) - Number(one === edited));
  const words = changed.slice(0, CHANGES).map((name) => {
    const [label, text] = inputs[name];
    return `${label.split(",")[0]} ${before.inputs[name][1] || "–"} → ${text || "–"}`;
  });
  const more = changed.length - words.length;
  return words.join(", ") + (more ? ` and ${more} more` : "");
}
function render() {
  /** @type {{number: number, words: string, one: Step, before?: Step}[]} */
  const listed = [];
  for (const number of Object.keys(steps).map(Number)) {
    const before = listed.at(-1)?.one, one = { ...steps[number] };
    const words = before ? changes(one, before) : number ? "earlier" : "start";
    if (words) listed.push({ number, words, one, before });
    else if (one.pressure) Object.assign(before, { pressure: one.pressure, sign: one.sign }); // by another view
  }
  const current = listed.filter(({ number }) => number <= step()).at(-1);
  list.replaceChildren(...listed.reverse().map((entry) => {
    const { number, words, one, before } = entry;
    const effect = [before, one].filter((each) => each?.pressure).map((each) => `${each.pressure} ${each.sign}`);
    const small = element("small", {}, one.pressure && effect.join(" → "));
    const button = element("button", { type: "button" }, words, small);
    if (entry === current) button.setAttribute("aria-current", "true");
    button.addEventListener("click", () => history.go(number - step()));
    return element("li", {}, button);
  }));
}
// history.js has written the link of the message into the address
listen((message, request) => {
  if (message.fresh) inputs = {};
  for (const [name, field] of Object.entries(message))
    if (/^=(?!.*\.\d+\.)/.test(name) && TEXTS[field.kind]) inputs[name.slice(1)] = [field.label, TEXTS[field.kind](field)];
  const [pressure, verdict] = ["dd[data-name=max_pressure]", ".verdict"].map((part) =>
    document.querySelector(`section:not([hidden]) #press-numbers ${part}`)?.textContent ?? "");
  const edited = request?.words.name || steps[step()]?.edited || "";
  steps[step()] = { edited, inputs: { ...inputs }, pressure, sign: verdict.slice(0, 1) };
  for (const number of Object.keys(steps).map(Number))
    if (number > latest() || number < step() - KEPT) delete steps[number];
  if (place.open) render();
});
place.addEventListener("toggle", render);
addEventListener("pagehide", () => sessionStorage.setItem(KEY, JSON.stringify(steps)));
