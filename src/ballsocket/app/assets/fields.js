// Inputs made of plain data: each tells its name and what was typed, and shows what the server says of it.
(function () {
  const app = (window.ballsocket = window.ballsocket || {});
  const fields = new Map(); // by name: what the server said last, the element, and how to put one into the other
  const typing = new Set(); // boxes with text that nobody has confirmed yet

  function element(tag, attributes = {}, ...inside) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...inside);
    return made;
  }
  const edit = (name, value) => app.tell("edit", name, value);
  const choose = (name, value) => app.tell(["answered_by", "shown", "painted", "angle", "size", "units"].includes(name) ? "choose" : "edit", name, value);
  const tidy = (value, step) => Number((Math.round(value / step) * step).toPrecision(12));

  function number(name) {
    const label = element("label", { for: `in-${name}`, id: `label-${name}` });
    const unit = element("span", { class: "unit", id: `unit-${name}` });
    const named = { "aria-labelledby": `label-${name} unit-${name}` };
    const box = element("input", { id: `in-${name}`, type: "text", inputmode: "decimal", autocomplete: "off", ...named });
    const sizes = element("datalist", { id: `sizes-${name}` });
    const bar = element("input", { type: "range", step: "any", ...named });
    const made = element("div", { class: "field number" }, label, element("span", { class: "box" }, box, unit), bar, sizes);
    let field;
    function moved(value) {
      const tidied = Math.min(field.high, Math.max(field.low, value));
      typing.delete(name);
      bar.value = tidied;
      box.value = String(tidied);
      edit(name, tidied);
    }
    function keys(event) {
      if (field.value === null) return;
      const steps = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10, ...(event.target === bar ? { ArrowRight: 1, ArrowLeft: -1 } : {}) };
      const step = steps[event.key];
      if (step) moved(tidy(Number(bar.value) + step * field.step, field.step / 100));
      else if (event.target === bar && event.key === "Home") moved(field.low);
      else if (event.target === bar && event.key === "End") moved(field.high);
      else return;
      event.preventDefault();
    }
    bar.addEventListener("keydown", keys);
    box.addEventListener("keydown", keys);
    bar.addEventListener("input", () => moved(tidy(Number(bar.value), field.step)));
    box.addEventListener("input", () => typing.add(name));
    box.addEventListener("change", () => {
      typing.delete(name);
      if (box.value.trim() || name === "allowable") edit(name, box.value.trim());
      else put(field); // an emptied box: what was there is still true
    });
    function put(said) {
      field = said;
      label.textContent = field.label;
      unit.textContent = field.unit;
      if (field.sizes) {
        sizes.replaceChildren(...field.sizes.map((value) => element("option", { value })));
        box.setAttribute("list", sizes.id);
      }
      bar.hidden = field.value === null;
      if (!typing.has(name)) box.value = field.text;
      if (bar.hidden) return;
      for (const [key, value] of [["min", field.low], ["max", field.high]]) bar[key] = value;
      bar.value = field.value;
      bar.setAttribute("aria-valuetext", `${field.text} ${field.unit}`.trim());
    }
    return { made, put };
  }

  function choice(name) {
    const label = element("label", { for: `in-${name}` });
    const list = element("select", { id: `in-${name}` });
    const made = element("div", { class: "field choice" }, label, list);
    list.addEventListener("change", () => choose(name, list.value));
    function put(field) {
      label.textContent = field.label;
      if (list.dataset.options !== JSON.stringify(field.options)) {
        list.dataset.options = JSON.stringify(field.options);
        list.replaceChildren(...field.options.map(([value, words]) => element("option", { value }, words)));
      }
      list.value = field.value;
    }
    return { made, put };
  }

  function group(kind, name, input, put) {
    const title = element("span", { class: "label", id: `label-${name}` });
    const row = element("div", { class: kind, role: kind === "segments" ? "radiogroup" : "group", "aria-labelledby": `label-${name}` });
    const made = element("div", { class: "field" }, title, row);
    return {
      made,
      put(field) {
        title.textContent = field.label;
        if (row.dataset.options !== JSON.stringify(field.options)) {
          row.dataset.options = JSON.stringify(field.options);
          row.replaceChildren(...field.options.map(([value, words]) => {
            const one = element("input", { type: input, name: `in-${name}`, value });
            const piece = element("span", {});
            piece.innerHTML = (field.pieces || {})[value] || "";
            piece.append(words);
            return element("label", {}, one, piece);
          }));
        }
        for (const one of row.querySelectorAll("input")) one.checked = put(field, one.value);
      },
    };
  }

  function segments(name) {
    const found = group("segments", name, "radio", (field, value) => field.value === value);
    found.made.addEventListener("change", (event) => choose(name, event.target.value));
    return found;
  }

  function several(name) {
    const found = group("several", name, "checkbox", (field, value) => field.value.includes(value));
    found.made.addEventListener("change", () =>
      choose(name, [...found.made.querySelectorAll("input:checked")].map((one) => one.value)));
    return found;
  }

  function tick(name) {
    const box = element("input", { type: "checkbox" });
    const words = element("span", {});
    const made = element("label", { class: "field tick" }, box, words);
    box.addEventListener("change", () => edit(name, box.checked));
    return { made, put(field) { words.textContent = field.label; box.checked = field.value; } };
  }

  function words(name) {
    const label = element("label", { for: `in-${name}` });
    const box = element("textarea", { id: `in-${name}`, autocomplete: "off", spellcheck: "false" });
    const made = element("div", { class: "field words" }, label, box);
    box.addEventListener("input", () => typing.add(name));
    box.addEventListener("change", () => { typing.delete(name); edit(name, box.value); });
    return {
      made,
      put(field) {
        label.textContent = field.label;
        box.rows = field.rows;
        if (!typing.has(name)) box.value = field.value;
      },
    };
  }

  const makers = { number, choice, segments, several, tick, words };

  app.field = function (name, said) {
    let found = fields.get(name);
    if (!found || found.said.kind !== said.kind) {
      found = makers[said.kind](name);
      found.made.dataset.name = name;
      const place = document.querySelector(`[data-field="${name}"]`);
      if (place) place.replaceChildren(found.made);
      fields.set(name, found);
    }
    found.said = said;
    found.made.hidden = Boolean(said.hidden);
    found.put(said);
  };
  app.order = function (names) {
    const place = document.getElementById("controls");
    const wanted = names.map((name) => fields.get(name).made);
    const there = [...place.children];
    if (wanted.length !== there.length || wanted.some((one, at) => one !== there[at])) place.replaceChildren(...wanted);
  };
  app.known = (name) => (fields.get(name) || {}).said;
  app.moved = function (name, value) {
    const said = app.known(name);
    const tidied = Math.min(said.high, Math.max(said.low, tidy(value, said.step)));
    if (tidied !== said.value) edit(name, tidied);
  };
  app.again = function () { for (const found of fields.values()) found.put(found.said); };
})();
