// @ts-check
// The page: what the server answers is shown, and what a server cannot do: clipboard, files, the theme, news.
import { fillBlocks } from "./blocks.js";
import { ask, listen } from "./connection.js";
import { hit, tell } from "./elements.js";
import { arrange, showField } from "./fields.js";
import { isVisit, record, redo, theme, undo } from "./history.js";

const LARGEST = 100000; // bytes of a joint file or a table; the server has the same limit
const LOST = "Connection lost. These numbers may not belong to the inputs; reconnecting …";
const page = document.body;
/** @param {string} id  @returns {any} */
const at = (id) => document.getElementById(id);
const SMALL = 0.85, LARGE = 1.15; // sizes of the text of a picture, of that in which it is drawn
const CLIENT = "ballsocket.client"; // key of the plain form for clients in the storage of the browser
const filled = new Set(); // elements that the server has filled
const TABLE = "ballsocket.table"; // key of the latest table of a cycle in the storage of this window
// no link holds a table: it is sent again after a lost connection and after a reload, but not to another link
let table = isVisit ? null : JSON.parse(sessionStorage.getItem(TABLE));

listen((message, request) => {
  if (message.fresh) for (const name of filled) if (!(name in message)) fill(name, "");
  for (const [name, value] of Object.entries(message)) {
    if (name.startsWith("#")) fill(name, value);
    else if (name.startsWith("=")) showField(name.slice(1), value);
  }
  for (const [name, value] of Object.entries(message)) if (name.startsWith("@")) arrange(at(name.slice(1)), value);
  if (message.view) showView(message.view);
  if ("works" in message) markViews(message.works ?? {});
  if ("link" in message) page.toggleAttribute("data-unread", !message.link); // the address stays as it is
  if (message.file) save(message.file);
  const expected = message.expected || [];
  if (message.fresh || "expected" in message)
    for (const name of filled) at(name.slice(1)).toggleAttribute("data-expected", expected.includes(name));
  at("inputs").disabled = false;
  if (request) page.dataset.shown = page.dataset.view;
  if (table && message.fresh) table.lost = true;
  const wanted = new URLSearchParams(location.search).get("use.table");
  if (table?.lost && table.value.name === wanted && table.name.startsWith(`${page.dataset.view}.`)) sendTable();
  document.dispatchEvent(new CustomEvent("shown", { detail: message }));
});
function fill(name, content) {
  const element = at(name.slice(1));
  if (!element) return;
  filled.add(name);
  const open = [...element.querySelectorAll("details[data-why][open]")].map((one) => one.getAttribute("data-why"));
  /** @type {any} */
  const focus = element.contains(document.activeElement) && document.activeElement;
  const selector = focus?.dataset?.drag ? `[tabindex][data-drag="${focus.dataset.drag}"]`
    : focus?.matches?.("summary") ? `[data-why="${focus.parentElement.dataset.why}"] summary` : null;
  fillBlocks(element, content);
  for (const name of open) element.querySelector(`details[data-why="${name}"]`)?.setAttribute("open", "");
  if (selector) element.querySelector(selector)?.focus(); // what has the focus is a new one after each answer
}
function showView(name) {
  page.dataset.view = name;
  const every = (selector) => /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(selector));
  for (const section of every("section.view")) section.hidden = section.dataset.view !== name;
  for (const button of every("button[data-view]"))
    if (button.dataset.view === name) {
      button.setAttribute("aria-current", "page");
      button.scrollIntoView({ inline: "center", block: "nearest" }); // the views scroll sideways on a telephone
    } else button.removeAttribute("aria-current");
}
/** Mark the buttons of views whose work goes on or is done. @param {Record<string, string>} works */
function markViews(works) {
  for (const button of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("button[data-view]"))) {
    const mark = works[button.dataset.view] ?? "";
    button.dataset.work = mark;
    button.setAttribute("aria-description", { runs: "is being computed", done: "has a new result" }[mark] ?? "");
  }
}
function save(file) {
  const bytes = Uint8Array.from(atob(file.content), (letter) => letter.charCodeAt(0));
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = file.name;
  link.click();
  tell(`${file.name} is saved`);
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
async function read(input, request) {
  const file = input.files[0];
  input.value = "";
  if (!file) return;
  if (file.size > LARGEST) tell(`${file.name} is larger than ${LARGEST} bytes`);
  else request(file.name, decode(await file.arrayBuffer()));
}
function decode(bytes) { // UTF-8, UTF-16 with a byte order mark, or the code page of Windows
  const [first, second] = new Uint8Array(bytes.slice(0, 2));
  const wide = { 0xfffe: "utf-16le", 0xfeff: "utf-16be" }[256 * first + second];
  try { return new TextDecoder(wide ?? "utf-8", { fatal: true }).decode(bytes); }
  catch { return new TextDecoder("windows-1252").decode(bytes); }
}
function sendTable() {
  table.lost = false;
  ask("edit", table.name, table.value);
}
/**
 * Show each table that is wider than its place as blocks, in which the numbers have the headings of their columns; that
 * of the models with its main columns, unless all are asked for. Keep the text of pictures near the size of other text.
 */
function fit() {
  for (const place of document.querySelectorAll(".wide")) {
    place.classList.remove("cards", "compact");
    if (place.scrollWidth <= place.clientWidth) continue;
    if (place.matches(".models") && !at("press-all").checked) {
      place.classList.add("compact");
      continue;
    }
    const [top, ...rows] = place.querySelector("table").rows;
    const heads = [...top.cells].map((cell) => cell.firstChild?.textContent);
    for (const row of rows)
      for (const cell of [...row.cells].slice(1)) if (cell.colSpan === 1) cell.dataset.head = heads[cell.cellIndex];
    place.classList.add("cards");
  }
  /** @type {NodeListOf<SVGSVGElement>} */
  const pictures = document.querySelectorAll(".view:not([hidden]) :is(.picture, .triad)");
  for (const { parentElement, viewBox, clientWidth } of pictures) {
    const share = clientWidth / viewBox.baseVal.width;
    parentElement.style.setProperty("--grow", String(Math.min(LARGE / share, Math.max(1, SMALL / share))));
  }
}
function setTheme(name) {
  page.classList.remove("light", "dark");
  page.classList.add(name);
}

setTheme(new URLSearchParams(location.search).get("theme")
  || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
at("theme").addEventListener("click", () => {
  setTheme(theme() === "dark" ? "light" : "dark");
  record(location.search.slice(1), null);
});
function showClient(on) {
  page.toggleAttribute("data-client", on);
  at("client").setAttribute("aria-pressed", String(on));
}
showClient(localStorage.getItem(CLIENT) === "yes");
at("client").addEventListener("click", () => {
  showClient(!page.hasAttribute("data-client"));
  localStorage.setItem(CLIENT, page.hasAttribute("data-client") ? "yes" : "no");
});
at("undo").addEventListener("click", undo);
at("redo").addEventListener("click", redo);
at("share").addEventListener("click", () => {
  const show = () => tell(location.href);
  navigator.clipboard?.writeText(location.href).then(() => tell("copied"), show) ?? show();
});
at("joint-file").addEventListener("change", (event) =>
  read(event.target, (name, text) => ask("upload", "", "", { file: name, text })));
document.addEventListener("change", (event) => {
  const input = hit(event, "input[data-tell-file]");
  if (input) read(input, (name, text) => {
    table = { name: input.dataset.tellFile, value: { name, size: text.length, text } };
    sessionStorage.setItem(TABLE, JSON.stringify(table));
    sendTable();
  });
});
document.addEventListener("click", (event) => {
  const button = hit(event, "button");
  if (!button) return;
  const { view, file, tell: name, value } = button.dataset;
  if (view) ask("view", "", view);
  else if (file) { tell(`Preparing ${file} …`); ask("save", file, "", { kind: file }); }
  else if (name) ask("edit", name, value || true);
});
new MutationObserver(() => { at("lost").textContent = page.dataset.lost ? LOST : ""; })
  .observe(page, { attributeFilter: ["data-lost"] });
new ResizeObserver(fit).observe(at("view"));
at("press-all").addEventListener("change", fit);
document.addEventListener("shown", fit);
// answers first where there is little room
if (innerWidth <= 820) document.querySelector(".side").removeAttribute("open");
