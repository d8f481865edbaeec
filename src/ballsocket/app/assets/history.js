// @ts-check
// Undo and redo: each settled change of the screen is one entry of the browser's history.
import { ask, isPending, listen, withdraw } from "./connection.js";
import { hit } from "./svg.js";

const SETTLED = 600; // ms after the last change by the same input
let last = { gesture: null, time: 0 };

export const theme = () => (document.body.classList.contains("dark") ? "dark" : "light");
const step = () => (history.state && history.state.step) || 0;

/** Write a link into the address: into a new entry, unless it continues the change of the last one. */
export function record(link, request) {
  const query = `?${link.replace(/theme=\w+/, `theme=${theme()}`)}`;
  if (query === location.search || isPending("open ")) return;
  const gesture = request && request.words.do !== "open" ? request.gesture : null, now = performance.now();
  const continues = gesture === last.gesture && (typeof gesture === "number" || now - last.time < SETTLED);
  last = { gesture, time: now };
  if (!gesture || continues) history.replaceState(history.state, "", query);
  else history.pushState({ step: step() + 1 }, "", query);
}
export const undo = () => { if (step()) history.back(); };
export const redo = () => history.forward();

/** Show the screen of another link, as a new entry. */
export function visit(link) {
  history.pushState({ step: step() + 1 }, "", `?${link ? `${link}&` : ""}theme=${theme()}`);
  reopen();
}
function reopen() {
  last = { gesture: null, time: 0 };
  withdraw();
  ask("open", "", "", { query: location.search.slice(1) });
}

listen((message, request) => { if (message.link) record(message.link, request); });
addEventListener("popstate", reopen);
addEventListener("keydown", (event) => {
  const key = event.key.toLowerCase(), text = hit(event, "textarea, input[type=text]");
  if (text || !(event.ctrlKey || event.metaKey) || !["z", "y"].includes(key)) return;
  event.preventDefault();
  if (key === "y" || event.shiftKey) redo();
  else undo();
});
