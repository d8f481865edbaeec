// @ts-check
// Limits as rows: a quantity, at most or at least, a value with its unit, and a button that removes the row.
import { confirmTyped, element } from "./elements.js";

/** @param {string} name  @param {(name: string, rows: string[][]) => void} edit */
export function limits(name, edit) {
  const title = element("span", { class: "label", id: `label-${name}` });
  const list = element("div", { class: "limit-rows" });
  const error = element("p", { class: "refused", role: "alert", id: `error-${name}` });
  const add = element("button", { type: "button", class: "plain" }, "Add a limit");
  const node = element("div", { class: "field", role: "group", "aria-labelledby": title.id }, title, list, add, error);
  let field, focusLast = false;
  const inputsOf = (row) => [...row.querySelectorAll("select, input")];
  const rows = () => [...list.children].map((row) => inputsOf(row).map((input) => input.value));
  const send = (changed) => edit(name, changed);

  function addRow() {
    const quantity = element("select", { "aria-label": "quantity" });
    const sign = element("select", { "aria-label": "kind of limit" });
    const box = element("input", { type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": "value" });
    const remove = element("button", { type: "button", class: "plain", "aria-label": "Remove this limit" }, "×");
    const value = element("span", { class: "box" }, box, element("span", { class: "unit" }));
    const row = element("div", {}, quantity, sign, value, remove);
    quantity.replaceChildren(...field.options.map(([value, words]) => element("option", { value }, words)));
    sign.replaceChildren(...field.signs.map(([value, words]) => element("option", { value }, words)));
    const index = () => [...list.children].indexOf(row);
    quantity.addEventListener("change", () => { box.value = ""; send(rows()); }); // the server gives the present number
    sign.addEventListener("change", () => send(rows()));
    confirmTyped(box, () => {
      if (box.value.trim()) send(rows());
      else show(field);
    });
    remove.addEventListener("click", () => { const left = rows(); left.splice(index(), 1); send(left); add.focus(); });
    list.append(row);
  }
  add.addEventListener("click", () => {
    const used = rows().map((row) => row[0]);
    const unused = field.options.find(([value]) => !used.includes(value)) || field.options[0];
    focusLast = true;
    send([...rows(), [unused[0], field.signs[0][0], ""]]);
  });
  function show(next) {
    if (!field || JSON.stringify(field.options) !== JSON.stringify(next.options)) list.replaceChildren();
    field = next;
    title.textContent = field.label;
    const shown = field.refused ?? field.value;
    while (list.children.length > shown.length) list.lastChild.remove();
    while (list.children.length < shown.length) addRow();
    shown.forEach(([quantity, sign, text], index) => {
      const [first, second, box] = inputsOf(list.children[index]);
      [first.value, second.value] = [quantity, sign];
      list.children[index].querySelector(".unit").textContent = field.options.find(([value]) => value === quantity)[2];
      if (!box.dataset.typing) box.value = text;
      box.setAttribute("aria-invalid", field.wrong === index);
      if (field.wrong === index) box.setAttribute("aria-describedby", error.id);
      else box.removeAttribute("aria-describedby");
    });
    error.textContent = field.error || "";
    error.hidden = !field.error;
    if (focusLast && list.lastChild) { list.lastChild.querySelector("input").select(); focusLast = false; }
  }
  return { node, show };
}
