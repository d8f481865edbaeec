// The page's end of the line to the server, and what a server cannot do: the address, the clipboard, files, the theme.
(function () {
  const app = (window.ballsocket = window.ballsocket || {});
  const LARGEST = 100000; // bytes of a joint file; the server has the same limit
  const PATIENCE = 15000; // ms until a question without an answer is given up
  const at = (id) => document.getElementById(id);
  const root = () => document.querySelector(".app");
  const say = (words) => { at("said").textContent = words; };
  const address = new URL(window.location.href);
  if (!address.searchParams.has("theme") && window.matchMedia("(prefers-color-scheme: dark)").matches) {
    address.searchParams.set("theme", "dark");
    window.location.replace(address);
  }

  // one question at a time: while it is on its way a slider may move on, and only its last place is asked for
  const queue = new Map();
  let number = 0, open = 0, given_up = 0;
  app.tell = function (what, name, value, more = {}) {
    queue.set(`${what} ${name}`, { do: what, name, value, ...more });
    pump();
  };
  function pump() {
    root().dataset.idle = queue.size || open ? "no" : "yes";
    if (open || !queue.size) return;
    const [key, words] = queue.entries().next().value;
    queue.delete(key);
    open = ++number;
    for (const doc of Bokeh.documents) {
      const ears = doc.get_model_by_name("asked");
      if (ears) ears.value = JSON.stringify({ n: open, ...words });
    }
    given_up = window.setTimeout(() => { open = 0; pump(); }, PATIENCE);
  }
  app.hear = function (text) {
    const message = JSON.parse(text);
    if (message.n === open) { window.clearTimeout(given_up); open = 0; }
    show(message);
    at("inputs").disabled = false;
    root().dataset.shown = root().dataset.view;
    pump();
  };

  function show(message) {
    for (const [key, value] of Object.entries(message)) {
      if (key.startsWith("#")) written(at(key.slice(1)), value);
      else if (key.startsWith("=") && !queue.has(`edit ${key.slice(1)}`) && !queue.has(`choose ${key.slice(1)}`)) app.field(key.slice(1), value);
      else if (key === "view") viewed(value);
      else if (key === "link" && !message.starting) window.history.replaceState(null, "", "?" + value);
      else if (key === "file") saved(value);
      else if (key === "reset") app.again();
    }
    if (message.order) app.order(message.order);
    document.dispatchEvent(new CustomEvent("shown", { detail: message }));
  }
  function written(place, html) {
    const held = place.contains(document.activeElement) ? document.activeElement.dataset.drag : null;
    place.innerHTML = html;
    const again = held && place.querySelector(`[tabindex][data-drag="${held}"]`);
    if (again) again.focus(); // whoever moves a handle goes on with the new one
  }
  function viewed(name) {
    root().dataset.view = name;
    let light = false;
    for (const each of document.querySelectorAll("section.view")) {
      each.hidden = each.dataset.view !== name;
      light = light || !each.hidden;
    }
    at("panels").hidden = light;
    for (const button of document.querySelectorAll("[data-view]:is(button)")) {
      if (button.dataset.view === name) button.setAttribute("aria-current", "page");
      else button.removeAttribute("aria-current");
    }
  }
  function saved(file) {
    const bytes = Uint8Array.from(atob(file.content), (one) => one.charCodeAt(0));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = file.name;
    link.click();
    say(`${file.name} is saved`);
    window.setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  document.addEventListener("DOMContentLoaded", () => {
    show({ ...JSON.parse(at("start").textContent), starting: true });
    at("share").addEventListener("click", () => {
      const link = window.location.href;
      if (navigator.clipboard) navigator.clipboard.writeText(link).then(() => say("copied"), () => say(link));
      else say(link);
    });
    at("theme").addEventListener("click", () => {
      const here = new URL(window.location.href);
      here.searchParams.set("theme", root().classList.contains("dark") ? "light" : "dark");
      window.location.assign(here);
    });
    for (const button of document.querySelectorAll("button[data-view]"))
      button.addEventListener("click", () => app.tell("choose", "view", button.dataset.view));
    for (const button of document.querySelectorAll("button[data-file]"))
      button.addEventListener("click", () => { say("is being made"); app.tell("save", button.dataset.file, "", { kind: button.dataset.file }); });
    const input = at("joint-file");
    input.addEventListener("change", async () => {
      const file = input.files[0];
      input.value = "";
      if (!file) return;
      if (file.size > LARGEST) { say(`${file.name} is larger than ${LARGEST} bytes; a joint file is a few lines`); return; }
      say("");
      app.tell("upload", "", "", { text: await file.text() });
    });
    if (window.innerWidth <= 820) document.querySelector(".side").open = false; // answers first where there is little room
  }, { once: true }); // Panel tells it a second time
})();
