// @ts-check
// Answers made of plain data: sentences, lists, numbers, checks, tables, charts and the section of the joint.
import { charts } from "./charts.js";
import { ask } from "./connection.js";
import { element, parsed, swatch } from "./elements.js";
import { scale, section } from "./section.js";

/** Text, remark below it, style, title of a head, and HTML below a head. @typedef {string | string[]} Cell */
/** @param {string} tag  @param {Cell} content  @param {Record<string, any>} more */
function cell(tag, content, more = {}) {
  const [text, small, style, title, html] = [content].flat();
  const node = element(tag, { ...(style && { class: style }), ...(title && { title }), ...more }, text);
  if (small) node.append(element("small", {}, small));
  if (html) node.append(parsed(html));
  return node;
}

function sentence({ text, style }) {
  return element("p", { class: style, ...(style.startsWith("verdict") && { role: "status" }) }, text);
}
function items({ texts, style }) {
  return element("ul", { class: style }, ...texts.map((text) => element("li", {}, text)));
}
function numbers({ rows, style }) {
  return element("dl", { class: style }, ...rows.map(([name, title, text, unit, more, value, why]) => {
    const about = name && element("details", { "data-why": name, ...(why && { open: "" }) },
      element("summary", {}, title), element("p", {}, why));
    const known = value === null ? {} : { "data-name": name, "data-value": value };
    const number = element("dd", known, text, element("span", { class: "unit" }, unit));
    if (more) number.append(element("small", {}, more));
    return element("div", {}, element("dt", {}, about || title), number);
  }));
}
function checks({ rows }) {
  const heads = ["check", "demand", "capacity", "ratio", "result", "source"];
  const lines = rows.map(({ title, demand, bar, capacity, ratio, width, state, result, source }) => {
    const fill = element("i");
    fill.style.width = `${width}%`;
    const measure = element("td", {}, element("span", { class: "bar", "aria-hidden": "true" }, fill), ratio);
    return element("tr", { class: state }, cell("th", title, { scope: "row" }), cell("td", [demand, bar]),
      cell("td", capacity), measure, cell("td", [result, "", "result"]), cell("td", [source, "", "source"]));
  });
  const top = element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head)));
  return element("div", { class: "checks" }, element("table", {}, top, ...lines));
}
/** A row of cells, or one with a style, a line before its head and cells, of which the last reaches the end. */
function tableRow(row, count) {
  if (Array.isArray(row)) return element("tr", {}, ...row.map((content) => cell("td", content)));
  const { style, line, cells } = row;
  const node = element("tr", { class: style }, ...cells.map((content, index) => {
    const span = index === cells.length - 1 && cells.length < count ? { colspan: count - index } : {};
    if (index === 0 && cells.length > 1) return cell("th", content, { scope: "row" });
    return cell("td", content, span);
  }));
  if (line) node.firstChild.prepend(swatch(line));
  return node;
}
function table({ heads, rows, style }) {
  const headOf = (head) => (head ? cell("th", head, { scope: "col" }) : element("td"));
  const top = element("tr", {}, ...heads.map(headOf));
  const lines = rows.map((row) => tableRow(row, heads.length));
  const words = heads.flatMap((head) => (Array.isArray(head) ? head[0] : head) || []).join(", "); // of this table alone
  const region = { class: `wide ${style}`, tabindex: "0", role: "region", "aria-label": words || "table" };
  return element("div", region, element("table", {}, top, ...lines));
}
const makers = { sentence, items, numbers, checks, table, charts, section, scale };

/** Fill an element with HTML, or with blocks and pieces of HTML. @param {Element} place  @param {any} content */
export function fillBlocks(place, content) {
  if (typeof content === "string") place.innerHTML = content;
  else place.replaceChildren(...content.map((block) => (block.kind ? makers[block.kind](block, place) : parsed(block))));
}
document.addEventListener("toggle", (event) => { // an explanation is sent when it is opened
  const about = /** @type {HTMLDetailsElement} */ (event.target), name = about.dataset?.why;
  const open = [...document.querySelectorAll("#press-numbers dt details[open]")];
  if (about.closest("dt") && name && (about.open === !about.querySelector("p").textContent))
    ask("edit", "press.why", open.map((one) => /** @type {HTMLElement} */ (one).dataset.why));
}, true);
