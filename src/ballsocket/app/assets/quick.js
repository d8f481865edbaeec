// @ts-check
// Numbers under a load that is moved, from the curve of the present joint, until the server confirms them.
import { listen, pendingValue } from "./connection.js";
import { digits } from "./elements.js";

/** @type {{load: number[], values: Record<string, (number | null)[]>} | null} */
let curve = null;
let isAlone = true; // no other input was changed since the last answer
const numbers = () => document.getElementById("press-numbers");

/** @param {any} load */
function show(load) {
  const above = curve && typeof load === "number" ? curve.load.findIndex((one) => one >= load) : -1;
  if (above < 1 || !isAlone) return;
  const share = (load - curve.load[above - 1]) / (curve.load[above] - curve.load[above - 1]);
  for (const [name, values] of Object.entries(curve.values)) {
    const text = numbers().querySelector(`dd[data-name=${name}]`)?.firstChild;
    const [low, high] = [values[above - 1], values[above]];
    if (text && low !== null && high !== null) text.nodeValue = digits(low + share * (high - low));
  }
  numbers().dataset.quick = "yes";
}
listen((message) => { if ("curve" in message) curve = message.curve; });
document.addEventListener("edited", (/** @type {CustomEvent} */ event) => {
  if (event.detail.name === "load") show(event.detail.value);
  else isAlone = false;
});
document.addEventListener("shown", () => {
  isAlone ||= document.body.dataset.idle === "yes";
  delete numbers().dataset.quick;
  show(pendingValue("load"));
});
