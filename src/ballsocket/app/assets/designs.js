// @ts-check
// Named designs: names and links that this browser keeps for all its windows.
import { ask, listen } from "./connection.js";
import { element, hit, tell } from "./elements.js";
import { known } from "./fields.js";
import { visit } from "./history.js";
import "./page.js"; // which shows a message first

const KEY = "ballsocket.designs", MAX = 50;
/** @typedef {{id: string, name: string, link: string, time: number, removed?: boolean}} Design */
const at = (id) => document.getElementById(id);
const chosen = new Set(); // designs that are ticked for a comparison
let current = history.state?.design ?? null; // the design that the address belongs to, if it is kept
/** @type {Design | null} */
let removed = null; // the design that can be restored

/** Return every record of this browser, by id. @returns {Map<string, Design>} */
function stored() {
  try {
    const records = JSON.parse(localStorage.getItem(KEY) || "[]");
    const valid = records.filter(({ id, link }) => typeof id === "string" && typeof link === "string");
    return new Map(valid.map((record) => [record.id, record]));
  } catch {
    return new Map();
  }
}
const kept = () => [...stored().values()].filter((design) => !design.removed);
const plain = (link) => link.replace(/(^|&)theme=\w+/, "").replace(/^&/, "");

/** Add records to those of all windows: of two with one id the later counts. @param {Design[]} records */
function write(...records) {
  const designs = stored();
  for (const record of records)
    if (!((designs.get(record.id)?.time ?? 0) > record.time)) designs.set(record.id, record);
  const gone = [...designs.values()].filter((design) => design.removed).sort((one, other) => other.time - one.time);
  for (const { id } of gone.slice(MAX)) designs.delete(id);
  try {
    localStorage.setItem(KEY, JSON.stringify([...designs.values()]));
  } catch {
    tell("This browser has no room for designs: save them as a file");
  }
  render();
}
function add(name, link) {
  if (kept().length >= MAX) {
    tell(`This browser keeps at most ${MAX} designs: delete one first`);
    return false;
  }
  current = `${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 10)}`;
  write({ id: current, name, link, time: Date.now() });
  return true;
}
/** Return a name that no other design has. */
function unique(name) {
  const names = new Set(kept().map((design) => design.name));
  let number = 2, free = name;
  while (names.has(free)) free = `${name} ${number++}`;
  return free;
}
function open(design) {
  current = design.id;
  visit(design.link);
}
const name = () => known("name")?.value || "design";
const actions = {
  keep() { add(name(), plain(location.search.slice(1))); mark(); },
  start() {
    const free = unique("design");
    if (!add(free, "")) return;
    visit("");
    ask("edit", "name", free);
  },
  duplicate() {
    const free = unique(`${name()} copy`);
    if (add(free, plain(location.search.slice(1)))) ask("edit", "name", free);
  },
  remove() {
    removed = stored().get(current);
    current = null;
    write({ ...removed, removed: true, time: Date.now() });
    mark();
  },
  restore() {
    current = removed.id;
    write({ ...removed, time: Date.now() });
    removed = null;
    open(stored().get(current));
  },
  compare() {
    const links = kept().filter(({ id }) => chosen.has(id) && id !== current).map(({ link }) => link);
    if (links.length) ask("edit", "designs.compare", links);
    else tell("Tick the designs to compare with this one");
  },
  save() {
    const links = kept().map(({ link }) => link);
    ask("edit", "designs.save", links.length ? links : [plain(location.search.slice(1))]);
  },
};
function render() {
  const designs = kept();
  at("design-count").textContent = designs.length ? `(${designs.length})` : "";
  at("design-list").replaceChildren(...designs.map((design) => {
    const tick = element("input", { type: "checkbox", "aria-label": `Compare ${design.name}` });
    tick.checked = chosen.has(design.id);
    tick.disabled = design.id === current;
    tick.addEventListener("change", () => (tick.checked ? chosen.add(design.id) : chosen.delete(design.id)));
    const button = element("button", { type: "button" }, design.name);
    if (design.id === current) button.setAttribute("aria-current", "true");
    button.addEventListener("click", () => open(design));
    return element("li", {}, tick, button);
  }));
  if (removed) at("design-list").append(element("li", {},
    element("button", { type: "button", "data-design": "restore" }, `Restore ${removed.name}`)));
  document.querySelector("[data-design=keep]").toggleAttribute("hidden", stored().has(current));
  document.querySelector("[data-design=remove]").toggleAttribute("disabled", !stored().has(current));
}
/** Note in the history which design an address belongs to, so that Back returns to the design too. */
function mark() {
  if ((history.state?.design ?? null) !== current) history.replaceState({ ...history.state, design: current }, "");
  render();
}

// page.js has shown the message by now, and history.js has written its link into the address
listen((message, request) => {
  if ((message.fresh || request?.words.do === "open") && message["#trouble"]) current = null; // its link cannot be read
  for (const link of (message.designs || []).reverse()) { // the first is on the screen, and is added last
    const words = new URLSearchParams(link), same = kept().find((design) => design.link === plain(link));
    if (same) {
      current = same.id; // a session file that is opened again adds nothing twice
      continue;
    }
    if (!add(unique(words.get("name") || words.get("preset") || "design"), plain(link))) break;
  }
  if (!message.link && !message["=name"]) return;
  const link = plain(location.search.slice(1)), design = stored().get(current);
  const changed = design && (design.link !== link || design.name !== name());
  if (changed) write({ ...design, link, name: name(), time: Date.now() });
  else if (!design && request?.words.name === "name") add(name(), link);
  document.title = `${name()} – ballsocket`;
  mark();
});
document.addEventListener("click", (event) => {
  const button = hit(event, "[data-design]");
  if (button) actions[button.dataset.design]();
});
addEventListener("popstate", () => { current = history.state?.design ?? null; });
addEventListener("storage", (event) => { if (event.key === KEY) render(); });
render();
