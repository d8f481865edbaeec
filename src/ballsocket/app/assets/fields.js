// @ts-check
// Inputs made of plain data: each asks for its change, and shows what the server says of it.
import { ask, listen, pendingValue } from "./connection.js";
import { confirmTyped, element, swatch } from "./elements.js";

/**
 * @typedef {Record<string, any>} Field
 * @typedef {{node: HTMLElement, show: (field: Field) => void, field?: Field, units?: Record<string, string>}} Input
 * @type {Map<string, Input>}
 */
const inputs = new Map(); // by name: the element, what the server said last, and how to show it
const stale = new Set(); // inputs that show an edit, until the server has answered it
const UNITS = ["units", "size", "angle"]; // choices that change what a number means

function edit(name, value) {
  stale.add(name);
  ask("edit", name, value, { units: inputs.get(name).units }); // another choice of units may be on its way
  document.dispatchEvent(new CustomEvent("edited", { detail: { name, value } }));
}
const rounded = (value, step) => Number((Math.round(value / step) * step).toPrecision(12));
/** @param {number} value  @param {Field} field */
const within = (value, { low, high }) => Math.min(high, Math.max(low, value));

/** Add a place for the refusal of typed text, which stays in its box; return what shows a sentence there. */
function errorBelow(node, box, name) {
  const text = element("p", { class: "error", id: `error-${name}`, role: "alert", hidden: "" });
  node.append(text);
  return (sentence) => {
    text.textContent = sentence || "";
    text.hidden = !sentence;
    if (sentence) box.setAttribute("aria-describedby", text.id);
    else box.removeAttribute("aria-describedby");
    box.setAttribute("aria-invalid", Boolean(sentence));
  };
}

function number(name) {
  const label = element("label", { for: `in-${name}`, id: `label-${name}` });
  const unit = element("span", { class: "unit", id: `unit-${name}` });
  const names = { "aria-labelledby": `label-${name} unit-${name}` };
  const typing = { type: "text", inputmode: "decimal", autocomplete: "off", maxlength: 100 };
  const box = element("input", { id: `in-${name}`, ...typing, ...names });
  const sizes = element("datalist", { id: `sizes-${name}` });
  const bar = element("input", { type: "range", step: "any", tabindex: -1, ...names });
  const boxed = element("span", { class: "box" }, box, unit);
  const node = element("div", { class: "field number" }, label, boxed, bar, sizes);
  const showError = errorBelow(node, box, name);
  let field;
  function set(value) {
    delete box.dataset.typing;
    bar.value = within(value, field);
    box.value = String(within(value, field));
    edit(name, within(value, field));
  }
  function reset() {
    delete box.dataset.typing;
    if (field.error) edit(name, null); // forgets the refused text
    else show(field);
  }
  function keys(event) {
    if (event.key === "Escape") reset();
    if (field.value === null) return;
    const sideways = event.target === bar ? { ArrowRight: 1, ArrowLeft: -1 } : {};
    const steps = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10, ...sideways }[event.key];
    if (steps) set(rounded(Number(bar.value) + steps * field.step, field.step / 100));
    else if (event.target === bar && event.key === "Home") set(field.low);
    else if (event.target === bar && event.key === "End") set(field.high);
    else return;
    event.preventDefault();
  }
  bar.addEventListener("keydown", keys);
  box.addEventListener("keydown", keys);
  bar.addEventListener("input", () => set(rounded(Number(bar.value), field.step)));
  confirmTyped(box, () => {
    const text = box.value.trim();
    if (text || field.optional) edit(name, text);
    else reset(); // in an emptied box the last value is still true
  });
  function show(next) {
    field = next;
    label.textContent = field.label;
    label.title = field.hint || "";
    unit.textContent = field.unit;
    showError(field.error);
    if (field.sizes) {
      sizes.replaceChildren(...field.sizes.map((value) => element("option", { value })));
      box.setAttribute("list", sizes.id);
    }
    bar.hidden = field.value === null;
    if (!box.dataset.typing) box.value = field.refused ?? field.text;
    if (bar.hidden) return;
    bar.min = field.low;
    bar.max = field.high;
    bar.value = field.value;
    bar.setAttribute("aria-valuetext", `${field.text} ${field.unit}`.trim());
  }
  return { node, show };
}

function choice(name) {
  const label = element("label", { for: `in-${name}` });
  const list = element("select", { id: `in-${name}` });
  list.addEventListener("change", () => edit(name, list.value));
  function show(field) {
    label.textContent = field.label;
    if (list.dataset.options !== JSON.stringify(field.options)) {
      list.dataset.options = JSON.stringify(field.options);
      list.replaceChildren(...field.options.map(([value, words]) => element("option", { value }, words)));
    }
    list.value = list.title = field.value; // the short name, as files and links have it
  }
  return { node: element("div", { class: "field choice" }, label, list), show };
}

function group(kind, name, type, isChecked) {
  const title = element("span", { class: "label", id: `label-${name}` });
  const role = kind === "segments" ? "radiogroup" : "group";
  const row = element("div", { class: kind, role, "aria-labelledby": `label-${name}` });
  function show(field) {
    title.textContent = field.label;
    if (row.dataset.options !== JSON.stringify(field.options)) {
      row.dataset.options = JSON.stringify(field.options);
      row.replaceChildren(...field.options.map(([value, words]) => {
        const piece = element("span", {}, ...(field.lines ? [swatch(field.lines[value])] : []), words);
        return element("label", {}, element("input", { type, name: `in-${name}`, value }), piece);
      }));
    }
    for (const box of row.querySelectorAll("input")) box.checked = isChecked(field, box.value);
  }
  return { node: element("div", { class: "field" }, title, row), show };
}
function segments(name) {
  const input = group("segments", name, "radio", (field, value) => field.value === value);
  input.node.addEventListener("change", (event) => edit(name, event.target.value));
  return input;
}
function several(name) {
  const input = group("several", name, "checkbox", (field, value) => field.value.includes(value));
  input.node.addEventListener("change", () =>
    edit(name, [...input.node.querySelectorAll("input:checked")].map((box) => box.value)));
  return input;
}

function tick(name) {
  const box = element("input", { type: "checkbox" }), label = element("span");
  box.addEventListener("change", () => edit(name, box.checked));
  function show(field) {
    label.textContent = field.label;
    box.checked = field.value;
  }
  return { node: element("label", { class: "field tick" }, box, label), show };
}

function words(name, { rows }) {
  const label = element("label", { for: `in-${name}` });
  const settings = { id: `in-${name}`, autocomplete: "off", spellcheck: "false" };
  const box = rows > 1 ? element("textarea", { rows, ...settings }) : element("input", { type: "text", ...settings });
  const node = element("div", { class: "field words" }, label, box);
  const showError = errorBelow(node, box, name);
  confirmTyped(box, () => edit(name, box.value));
  function show(field) {
    label.textContent = field.label;
    showError(field.error);
    if (!box.dataset.typing) box.value = field.refused ?? field.value;
  }
  return { node, show };
}

// long work: the button turns to Cancel on the click itself, before the server has heard of it
function run(name) {
  const button = element("button", { type: "button" });
  const bar = element("progress", { max: 1, "aria-label": "progress" }), text = element("span", { role: "status" });
  let field;
  function show(next) {
    field = next;
    const works = field.share !== null;
    button.textContent = works ? "Cancel" : field.label;
    bar.hidden = !works;
    if (field.share) bar.value = field.share;
    else bar.removeAttribute("value");
    text.textContent = field.words;
  }
  button.addEventListener("click", () => {
    const starts = field.share === null;
    show({ ...field, share: starts ? 0 : null, words: starts ? "starting" : "Cancelled." });
    edit(name, starts);
  });
  // work ends with its connection: whoever waited for it goes on waiting
  listen((message) => { if (message.fresh && field.share !== null) edit(name, true); });
  return { node: element("div", { class: "field run" }, button, bar, text), show };
}

function button(name) {
  const node = element("button", { type: "button" });
  node.addEventListener("click", () => edit(name, true));
  function show(field) {
    node.textContent = field.label;
    node.setAttribute("aria-label", field.hint);
  }
  return { node: element("div", { class: "field" }, node), show };
}
// inputs in rows: the number of a row that is added here has the focus, and the button below when a row has gone
function rows(name) {
  const title = element("span", { class: "label", id: `label-${name}` }), list = element("div", { class: "rows" });
  const add = element("button", { type: "button" });
  const node = element("div", { class: "field", role: "group", "aria-labelledby": title.id }, title, list, add);
  let isAdding = false;
  add.addEventListener("click", () => { isAdding = true; edit(name, true); });
  function show(field) {
    [title.textContent, add.textContent] = [field.label, field.add];
    const hadFocus = list.contains(document.activeElement), before = list.children.length;
    arrange(list, field.names.map((inside) => `${name}.${inside}`));
    if (hadFocus && !list.contains(document.activeElement)) add.focus();
    if (!isAdding || list.children.length === before) return;
    isAdding = false;
    [...list.querySelectorAll(".box input")].at(-1).select();
  }
  return { node, show };
}

const makers = { number, choice, segments, several, tick, words, run, button, rows };

/** Show an input as the server says, unless an edit of it is still on the page. */
export function showField(name, field) {
  let input = inputs.get(name);
  if (!input || input.field.kind !== field.kind) {
    input = makers[field.kind](name, field);
    input.node.dataset.name = name;
    const home = document.querySelector(`[data-field="${name}"]`);
    if (home) home.replaceChildren(input.node);
    inputs.set(name, input);
  }
  input.field = field;
  input.node.hidden = Boolean(field.hidden);
  stale.add(name);
  refresh();
}
function refresh() {
  for (const name of [...stale]) {
    if (pendingValue(name) !== undefined) continue;
    stale.delete(name);
    inputs.get(name).show(inputs.get(name).field);
  }
}
document.addEventListener("shown", () => {
  refresh();
  const units = Object.fromEntries(UNITS.map((name) => [name, known(name).value]));
  for (const [name, input] of inputs) if (!stale.has(name)) input.units = units;
});
/** Put inputs without a place of their own into an element, in an order. @param {Element | null} home */
export function arrange(home, names) {
  if (!home) return;
  const isFree = (node) => node.parentElement === home || !node.closest("[data-field], .rows");
  const nodes = names.map((name) => inputs.get(name).node).filter(isFree);
  // those that stay are not moved: one of them may have the focus
  for (const child of /** @type {HTMLElement[]} */ ([...home.children])) {
    if (nodes.includes(child) || !child.dataset.name) continue;
    for (const box of child.querySelectorAll("input")) delete box.dataset.typing;
    child.remove();
  }
  nodes.forEach((node, index) => {
    if (node !== home.children[index]) home.insertBefore(node, home.children[index] ?? null);
  });
}
export const known = (name) => (inputs.get(name) || {}).field;
/** Ask for another value of a number, within its range and in its steps. */
export function move(name, value) {
  const field = known(name), next = rounded(within(value, field), field.step);
  if (next !== (pendingValue(name) ?? field.value)) edit(name, within(next, field));
}
