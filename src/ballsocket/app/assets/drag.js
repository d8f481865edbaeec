// Handles of the drawing: what is dragged, or moved by the arrow keys, is the number of an input.
(function () {
  const app = window.ballsocket;
  let held = null;

  function place(event) {
    const svg = document.querySelector("#press-section svg");
    const [x, y] = svg.dataset.centre.split(" ").map(Number);
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return { x: at.x - x, y: at.y - y, svg: svg.dataset };
  }
  function arrow({ x, y, svg }) {
    const load = app.known("load"), turn = app.known("tilt");
    const share = (Math.hypot(x, y) - Number(svg.start)) / Number(svg.long);
    app.moved("load", Math.min(1, Math.max(0, share)) * load.high);
    app.moved("tilt", Math.max(0, (Math.atan2(x, -y) * 180) / Math.PI) * turn.factor);
  }
  const drag = {
    arrow,
    ball({ y, svg }, held) {
      const load = app.known("load");
      app.moved("load", held.value + ((y - held.y) / (2 * Number(svg.long))) * load.high);
    },
    border({ x, y, svg }, held) {
      app.moved(held.name, (Math.hypot(x, y) / Number(svg.scale) - held.inner) * app.known(held.name).factor);
    },
  };
  document.addEventListener("pointerdown", (event) => {
    const handle = event.target.closest && event.target.closest("[data-drag]");
    if (!handle || document.getElementById("inputs").disabled) return;
    const name = handle.dataset.drag;
    held = { name, how: handle.dataset.how, inner: Number(handle.dataset.inner), y: place(event).y, value: app.known(name).value };
    document.documentElement.classList.add("dragging");
    event.preventDefault();
    handle.focus();
  });
  document.addEventListener("pointermove", (event) => { if (held) drag[held.how](place(event), held); });
  for (const end of ["pointerup", "pointercancel"])
    document.addEventListener(end, () => { held = null; document.documentElement.classList.remove("dragging"); });
  document.addEventListener("keydown", (event) => {
    const handle = event.target.closest && event.target.closest("[data-drag]");
    const steps = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 };
    if (!handle || !steps[event.key]) return;
    const said = app.known(handle.dataset.drag);
    app.moved(handle.dataset.drag, said.value + steps[event.key] * said.step);
    event.preventDefault();
  });
})();
