// @ts-check
// Undo and redo: each settled change of the screen is one entry of the browser's history.
import { ask, isPending, listen, withdraw } from "./connection.js";
import { hit } from "./elements.js";

const SETTLED = 600; // ms after the last change by the same input
let last = { gesture: null, time: 0 };

export const theme = () => (document.body.classList.contains("dark") ? "dark" : "light");
export const step = () => (history.state && history.state.step) || 0;
const TOP = "ballsocket.steps"; // key of the number of the latest entry in the storage of this window
export const latest = () => Number(sessionStorage.getItem(TOP));
/** Let the buttons show if there is something to undo or redo. */
function showSteps() {
  document.getElementById("undo").toggleAttribute("disabled", !step());
  document.getElementById("redo").toggleAttribute("disabled", step() >= latest());
}
function markLatest() {
  sessionStorage.setItem(TOP, String(step()));
  showSteps();
}
function enter(query) {
  history.pushState({ step: step() + 1 }, "", query);
  markLatest();
}

/** Write a link into the address: into a new entry, unless it continues the change of the last one. */
export function record(link, request) {
  const query = `?${link.replace(/theme=\w+/, `theme=${theme()}`)}`;
  if (query === location.search || isPending("open ")) return;
  const gesture = request && request.words.do !== "open" ? request.gesture : null, now = performance.now();
  const continues = gesture === last.gesture && (typeof gesture === "number" || now - last.time < SETTLED);
  last = { gesture, time: now };
  if (!gesture || continues) history.replaceState(history.state, "", query);
  else enter(query);
}
export const undo = () => { if (step()) history.back(); };
export const redo = () => history.forward();

/** Show the screen of another link, as a new entry. */
export function visit(link) {
  enter(`?${link ? `${link}&` : ""}theme=${theme()}`);
  reopen();
}
function reopen() {
  showSteps();
  last = { gesture: null, time: 0 };
  withdraw();
  ask("open", "", "", { query: location.search.slice(1) });
}

const [navigation] = /** @type {PerformanceNavigationTiming[]} */ (performance.getEntriesByType("navigation"));
export const isVisit = navigation.type === "navigate"; // not a reload, and no step in the history
if (isVisit) markLatest();
else showSteps();
listen((message, request) => { if (message.link) record(message.link, request); });
addEventListener("popstate", reopen);
addEventListener("keydown", (event) => {
  const key = event.key.toLowerCase(), typing = hit(event, "[data-typing]");
  if (typing || !(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key)) return;
  event.preventDefault();
  if (key === "y" || event.shiftKey) redo();
  else undo();
});
