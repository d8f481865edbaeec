// A bore in three dimensions: quadrilaterals from the furthest to the nearest, turned by dragging or by the arrow keys.
(function () {
  const app = (window.ballsocket = window.ballsocket || {});
  const HEAT = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const turned = new Map(); // by name: how it was turned last, which outlives what is drawn
  function heat(share) {
    const place = Math.min(0.9999, Math.max(0, share)) * (HEAT.length - 1), low = Math.floor(place), part = place - low;
    return HEAT[low].map((value, each) => value + part * (HEAT[low + 1][each] - value));
  }
  const unit = (polar, around, size) => [size * Math.sin(polar) * Math.cos(around), size * Math.sin(polar) * Math.sin(around), size * Math.cos(polar)];
  function cells(data) {
    const found = [], steps = data.meridians, step = (2 * Math.PI) / steps, reach = data.polar.at(-1);
    const quad = (one, other, at, size, more) => ({
      corners: [unit(one, at, size), unit(other, at, more.wide || size), unit(other, at + step, more.wide || size), unit(one, at + step, size)],
      ...more,
    });
    for (let ring = 0; ring + 1 < data.polar.length; ring++)
      for (let place = 0; place < steps; place++)
        found.push(quad(data.polar[ring], data.polar[ring + 1], place * step, 1, { cell: ring * steps + place }));
    const outer = 12;
    for (let place = 0; place < steps; place++) {
      found.push(quad(reach, reach, place * step, 1, { wide: data.outer }));
      for (let ring = 0; ring < outer; ring++)
        found.push(quad((reach * ring) / outer, (reach * (ring + 1)) / outer, place * step, data.outer, {}));
    }
    return found;
  }
  // right is the cup's y, up its x, towards the eye out of its opening
  function seen([x, y, z], [yaw, pitch]) {
    const toward = -z, right = y * Math.cos(yaw) + toward * Math.sin(yaw), deep = toward * Math.cos(yaw) - y * Math.sin(yaw);
    return [right, x * Math.cos(pitch) - deep * Math.sin(pitch), x * Math.sin(pitch) + deep * Math.cos(pitch)];
  }
  function draw(canvas) {
    const { data, quads } = canvas.bowl, turn = turned.get(canvas.dataset.name), style = getComputedStyle(canvas);
    const sharp = window.devicePixelRatio || 1, size = canvas.clientWidth;
    if (!size) return;
    canvas.width = canvas.height = size * sharp;
    const pen = canvas.getContext("2d"), scale = (0.46 * size * sharp) / data.outer, middle = (size * sharp) / 2;
    const at = (place) => [middle + scale * place[0], middle - scale * place[1]];
    const liner = style.getPropertyValue("--bowl").trim().split(",").map(Number);
    const full = canvas.bowl.bytes ? 255 : 1;
    const { values, load, size: share } = now(canvas.bowl);
    function arrow() {
      const tip = at(seen(load.map((part) => 0.97 * part), turn)), tail = at(seen(load.map((part) => (0.67 - 1.02 * share) * part), turn));
      const angle = Math.atan2(tip[1] - tail[1], tip[0] - tail[0]), head = 9 * sharp;
      pen.strokeStyle = pen.fillStyle = style.getPropertyValue("--load").trim();
      pen.lineWidth = 3 * sharp;
      pen.beginPath(); pen.moveTo(...tail); pen.lineTo(...tip); pen.stroke();
      pen.beginPath(); pen.moveTo(...tip);
      for (const side of [0.4, -0.4]) pen.lineTo(tip[0] - head * Math.cos(angle + side), tip[1] - head * Math.sin(angle + side));
      pen.fill();
    }
    const behind = seen([0, 0, -1], turn)[2] < 0; // the dome is nearer than the opening
    if (share && behind) arrow();
    const placed = quads.map((one) => ({ ...one, places: one.corners.map((corner) => seen(corner, turn)) }));
    for (const one of placed) one.deep = one.places.reduce((sum, place) => sum + place[2], 0);
    placed.sort((one, other) => one.deep - other.deep);
    for (const one of placed) {
      const [a, b, c] = one.places, d = one.places[3];
      const u = [c[0] - a[0], c[1] - a[1], c[2] - a[2]], v = [d[0] - b[0], d[1] - b[1], d[2] - b[2]];
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const light = 0.72 + 0.28 * Math.abs((normal[2] + 0.4 * normal[1]) / (Math.hypot(...normal) || 1) / 1.08);
      const value = one.cell === undefined ? 0 : values[one.cell] / full;
      const colour = (value > 0.004 ? heat(value) : liner).map((part) => Math.round(part * light));
      pen.fillStyle = pen.strokeStyle = `rgb(${colour})`;
      pen.lineWidth = 0.7 * sharp;
      pen.beginPath();
      one.places.forEach((place, number) => pen[number ? "lineTo" : "moveTo"](...at(place)));
      pen.closePath(); pen.fill(); pen.stroke();
    }
    if (share && !behind) arrow();
  }
  // what is drawn now: of a bore that moves an instant of its cycle
  function now({ data, bytes, frame = 0 }) {
    if (!bytes) return { values: data.values, load: data.load, size: data.load ? 1 : 0 };
    const count = bytes.length / data.loads.length;
    return { values: bytes.subarray(frame * count, (frame + 1) * count), load: data.loads[frame], size: data.sizes[frame] };
  }
  function turn(canvas, yaw, pitch) {
    const [was, high] = turned.get(canvas.dataset.name);
    turned.set(canvas.dataset.name, [was + yaw, Math.max(-1.6, Math.min(1.6, high + pitch))]);
    draw(canvas);
  }
  function begin(canvas) {
    const data = JSON.parse(canvas.dataset.bowl);
    const bytes = data.bytes && Uint8Array.from(atob(data.bytes), (one) => one.charCodeAt(0));
    canvas.bowl = { data, bytes, quads: cells(data) };
    if (!turned.has(canvas.dataset.name)) turned.set(canvas.dataset.name, data.turned);
    let from = null;
    canvas.addEventListener("pointerdown", (event) => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      turn(canvas, (event.clientX - from[0]) / 120, (event.clientY - from[1]) / 120);
      from = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { from = null; });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.15], ArrowDown: [0, 0.15] }[event.key];
      if (event.key === "Home") turned.set(canvas.dataset.name, [0, 0]);
      else if (!step) return;
      event.preventDefault();
      turn(canvas, ...(step || [0, 0]));
    });
    new ResizeObserver(() => draw(canvas)).observe(canvas);
  }
  app.frame = function (canvas, number) {
    if (!canvas.bowl) begin(canvas);
    canvas.bowl.frame = number;
    draw(canvas);
  };
  document.addEventListener("shown", () => {
    for (const canvas of document.querySelectorAll("canvas.bowl")) if (!canvas.bowl) begin(canvas);
  });
})();
