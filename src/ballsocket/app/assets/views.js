// What views have in common: buttons that tell a view something, and maps on which a place is picked.
(function () {
  const app = (window.ballsocket = window.ballsocket || {});
  const LARGEST = 100000; // bytes of a table
  document.addEventListener("change", async (event) => {
    const input = event.target.closest("input[data-tell-file]"), file = input && input.files[0];
    if (!file) return;
    input.value = "";
    const text = file.size > LARGEST ? "" : await file.text();
    app.tell("edit", input.dataset.tellFile, { name: file.name, size: file.size, text });
  });
  document.addEventListener("click", (event) => {
    const button = event.target.closest("[data-tell]");
    if (button) { app.tell("edit", button.dataset.tell, button.dataset.value || true); return; }
    const map = event.target.closest("svg[data-pick]");
    if (!map) return;
    const [left, top, right, foot] = map.dataset.box.split(" ").map(Number);
    const [low, high, least, most] = map.dataset.pick.split(" ").map(Number);
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(map.getScreenCTM().inverse());
    const across = (place.x - left) / (right - left), up = (foot - place.y) / (foot - top);
    if (across < 0 || across > 1 || up < 0 || up > 1) return;
    app.tell("edit", "cup.pick", [low + across * (high - low), least + up * (most - least)]);
  });
})();
