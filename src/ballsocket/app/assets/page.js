// The few things that the server cannot do: the address, the clipboard, a file of the user's, the theme.
(function () {
  const LARGEST = 100000; // bytes; the server has the same limit
  const say = (words) => { const place = document.getElementById("said"); if (place) place.textContent = words; };
  const address = new URL(window.location.href);
  if (!address.searchParams.has("theme") && window.matchMedia("(prefers-color-scheme: dark)").matches) {
    address.searchParams.set("theme", "dark");
    window.location.replace(address);
  }
  window.ballsocket = {
    linked(query) {
      window.history.replaceState(null, "", "?" + query);
    },
  };
  function upload(text) {
    for (const doc of Bokeh.documents) {
      const model = doc.get_model_by_name("upload");
      if (model) { model.value = `${Date.now()}\n${text}`; return; }
    }
  }
  // sliders are made of parts that do not know their label: a screen reader is told it
  function within(root, selector) {
    const found = [...root.querySelectorAll(selector)];
    for (const each of root.querySelectorAll("*")) if (each.shadowRoot) found.push(...within(each.shadowRoot, selector));
    return found;
  }
  function named() {
    for (const slider of within(document, ".slider")) {
      const root = slider.shadowRoot || slider;
      const label = within(root, "label")[0];
      for (const handle of within(root, ".noUi-handle")) if (label) handle.setAttribute("aria-label", label.textContent.trim());
    }
  }
  window.setInterval(named, 700);
  document.addEventListener("DOMContentLoaded", () => {
    document.getElementById("share").addEventListener("click", () => {
      const link = window.location.href;
      if (navigator.clipboard) navigator.clipboard.writeText(link).then(() => say("copied"), () => say(link));
      else say(link);
    });
    document.getElementById("theme").addEventListener("click", () => {
      const here = new URL(window.location.href);
      here.searchParams.set("theme", document.querySelector(".app").classList.contains("dark") ? "light" : "dark");
      window.location.assign(here);
    });
    const input = document.getElementById("joint-file");
    input.addEventListener("change", async () => {
      const file = input.files[0];
      input.value = "";
      if (!file) return;
      if (file.size > LARGEST) { say(`${file.name} is larger than ${LARGEST} bytes; a joint file is a few lines`); return; }
      say("");
      upload(await file.text());
    });
    if (window.innerWidth <= 820) document.querySelector(".side").open = false; // answers first where there is little room
  });
})();
