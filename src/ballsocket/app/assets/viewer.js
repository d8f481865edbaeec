// @ts-check
// Cup, ball and load in three dimensions by WebGL: geometry is built once, and drawn only when something changes.
import { HEAT, hit } from "./elements.js";

const KINDS = [0, 1, 2, 3, 4, 5], [PLAIN, BORE, SECTION, BALL, LINE, ARROW] = KINDS; // of parts, as in the shader
const FLOATS = 8; // of a vertex: position, normal, place on the bore's field
const OBLIQUE = [0.6, -0.25]; // rad, of the first look: a depth is seen
const CIRCLE = 2 * Math.PI, STEPS = 72;
const SHARP = Math.max(1.5, window.devicePixelRatio || 1); // pixels of a picture for each of the page
const IDLE = 200; // ms after the last picture until it is drawn sharp; before, as sharp as it is quick
const VERTEX = `#version 300 es
  layout(location = 0) in vec3 position; layout(location = 1) in vec3 normal; layout(location = 2) in vec2 cell;
  uniform mat3 turn; uniform float size; out vec3 at, facing; out vec2 spot;
  void main() {
    vec3 seen = size * (turn * position);
    at = position; facing = turn * normal; spot = cell; gl_Position = vec4(seen.xy, -0.15 * seen.z, 1.0);
  }`;
const fragment = (kind) => `#version 300 es
  precision highp float; precision highp int;
  in vec3 at, facing; in vec2 spot; out vec4 paint; const int kind = ${kind};
  uniform sampler2D field; uniform bool film, solid;
  uniform vec3 colour, behind, sphere, radii; uniform vec4 section; uniform float reach, gain;
  const vec3 HEAT[5] = vec3[5](${HEAT.map((colour) => `vec3(${colour})`)});
  vec3 heat(float share) {
    float place = 4.0 * clamp(share, 0.0, 1.0); int low = min(int(place), 3);
    return mix(HEAT[low], HEAT[low + 1], place - float(low)) / 255.0;
  }
  vec2 value() { // with the share of the colour; a film is known inside the contact only
    vec2 known = texture(field, spot).rg; // value and its presence, both smooth between cells
    if (film) return vec2(known.r / max(known.g, 0.001), smoothstep(0.4, 0.6, known.g));
    return vec2(known.r, smoothstep(0.01, 0.05, known.r));
  }
  void main() {
    vec3 base = colour; float opacity = 1.0;
    if (kind < ${ARROW} && kind != ${SECTION} && dot(at, section.xyz) > section.w) discard;
    if (kind == ${BORE}) { vec2 known = value(); base = mix(colour, heat(gain * known.x), known.y); }
    if (kind == ${SECTION}) {
      float distance = length(at);
      if (solid && distance < radii.x) base = sphere;
      else if (distance < 1.0 || distance > radii.z || acos(at.z / distance) > reach) discard;
      else base = distance < radii.y ? colour : behind;
    }
    if (kind == ${BALL}) { if (facing.z < 0.0) discard; opacity = 0.38; }
    bool flat_part = kind == ${LINE} || kind == ${SECTION};
    float light = flat_part ? 1.0 : 0.6 + 0.4 * abs(dot(normalize(facing), vec3(0.22, 0.44, 0.87)));
    paint = vec4(base * light * opacity, opacity);
  }`;
const direction = (polar, around) =>
  [Math.sin(polar) * Math.cos(around), Math.sin(polar) * Math.sin(around), Math.cos(polar)];
const scaled = (vector, factor) => vector.map((part) => factor * part);
const sum = (one, other) => one.map((part, axis) => part + other[axis]);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const normalised = (vector) => scaled(vector, 1 / (Math.hypot(...vector) || 1));

// right on the screen is the cup's y, up its x, towards the eye out of its opening; columns as WebGL has them
function rotation([yaw, pitch]) {
  const [c, s, d, t] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return [0, d, t, c, s * t, -s * d, -s, c * t, -c * d];
}
const seen = (turn, [x, y, z]) => [0, 1, 2].map((row) => turn[row] * x + turn[3 + row] * y + turn[6 + row] * z);
// half-way between the opening and the contact no wall is in front of the contact
function towards(load) {
  const [x, y, z] = normalised(sum(normalised(load), [0, 0, 1]));
  return [Math.atan2(y, z), Math.atan2(-x, Math.hypot(y, z))];
}

function geometry({ reach, radii: [ball, liner, outer], rings, outline }) {
  const vertices = [], indices = [], parts = [];
  function sheet(kind, colour, rows, columns, vertex) {
    const first = vertices.length / FLOATS, start = indices.length;
    for (let row = 0; row <= rows; row++)
      for (let column = 0; column <= columns; column++) vertices.push(...vertex(row / rows, column / columns));
    for (let row = 0; row < rows; row++)
      for (let column = 0; column < columns; column++) {
        const corner = first + row * (columns + 1) + column, next = corner + columns + 1;
        indices.push(corner, corner + 1, next, next, corner + 1, next + 1);
      }
    parts.push({ kind, colour, start, count: indices.length - start, rows, columns, at: first * FLOATS * 4 });
  }
  const shell = (kind, colour, rows, radius, end) => sheet(kind, colour, rows, STEPS, (row, column) => {
    const normal = direction(end * row, CIRCLE * column);
    return [...scaled(normal, radius), ...normal, column, (rings * row + 0.5) / (rings + 1)];
  });
  const rim = (colour, low, high) => sheet(PLAIN, colour, 1, STEPS, (row, column) => {
    const around = CIRCLE * column;
    const normal = direction(reach + CIRCLE / 4, around);
    return [...scaled(direction(reach, around), low + (high - low) * row), ...normal, 0, 0];
  });
  const ribbon = (points, width) => sheet(LINE, "--text", 1, points.length, (row, column) => {
    const number = Math.round(column * points.length);
    const at = (place) => points[(place + points.length) % points.length];
    const side = normalised(cross(at(number), sum(at(number + 1), scaled(at(number - 1), -1))));
    return [...scaled(sum(at(number), scaled(side, width * (row - 0.5))), 0.994), 0, 0, 0, 0, 0];
  });
  shell(BORE, "--bowl", 24, 1, reach);
  rim("--bowl", 1, liner);
  shell(PLAIN, outer > liner ? "--backing" : "--bowl", 14, outer, reach);
  if (outer > liner) rim("--backing", liner, outer);
  ribbon(Array.from({ length: STEPS }, (_, step) => direction(reach, (CIRCLE * step) / STEPS)), 0.022);
  if (outline) ribbon(outline, 0.02);
  sheet(SECTION, "--bowl", 1, 1, () => Array(FLOATS).fill(0));
  sheet(ARROW, "--load", 3, 24, () => Array(FLOATS).fill(0));
  shell(BALL, "--ball", 30, ball, CIRCLE / 2);
  return { vertices: new Float32Array(vertices), indices: new Uint16Array(indices), parts };
}

// the parts that move are few vertices, computed anew for each picture
function arrow(load, share, bases) {
  const [side, other] = bases, tail = 0.99 - 1.5 * share, neck = 0.99 - Math.min(0.24, 0.4 * share);
  const profile = [[tail, 0], [tail, 0.026], [neck, 0.026], [neck, 0.075], [0.99, 0]];
  return (row, column) => {
    const [along, wide] = profile[[1, 2, 3, 4][Math.round(row * 3)]], around = CIRCLE * column;
    const normal = sum(scaled(side, Math.cos(around)), scaled(other, Math.sin(around)));
    return [...sum(scaled(load, along), scaled(normal, wide)), ...normal, 0, 0];
  };
}
function plane(normal, distance, size) {
  const along = [-normal[1], normal[0], 0];
  return (row, column) => {
    const inside = sum(scaled(along, size * (2 * row - 1)), [0, 0, size * (2 * column - 1)]);
    return [...sum(scaled(normal, distance), inside), ...normal, 0, 0];
  };
}

class Viewer {
  shape = ""; // geometry that is built
  waiting = null; // request of the next picture
  constructor(name) {
    this.name = name;
    this.frame = this.last = 0;
    this.stage = document.createElement("div");
    this.stage.className = "stage";
    this.stage.innerHTML = `<canvas tabindex="0" role="img"></canvas>` +
      `<svg class="triad" viewBox="-50 -50 100 100" aria-hidden="true"></svg>`;
    this.tools = document.createElement("div");
    this.tools.className = "tools";
    this.tools.innerHTML =
      `<button type="button" data-act="contact">Show the contact</button>` +
      `<button type="button" data-act="+" aria-label="Zoom in">+</button>` +
      `<button type="button" data-act="-" aria-label="Zoom out">−</button>` +
      `<button type="button" data-act="reset">Reset</button><label><input type="checkbox"> Ball</label>` +
      `<label>Section <input type="range" min="-1" max="1" step="0.01" value="1" ` +
      `aria-label="Section plane: right end for none"></label>`;
    this.canvas = this.stage.querySelector("canvas");
    this.triad = this.stage.querySelector("svg");
    const inputs = this.tools.querySelectorAll("input");
    this.ball = inputs[0];
    this.section = inputs[1];
    this.begin();
    this.listen();
  }
  begin() {
    const gl = (this.gl = this.canvas.getContext("webgl2", { antialias: false }));
    if (!gl) return;
    this.programs = KINDS.map((kind) => this.program(gl, kind));
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    for (const [place, count, start] of [[0, 3, 0], [1, 3, 3], [2, 2, 6]]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, count, gl.FLOAT, false, FLOATS * 4, start * 4);
    }
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.built = this.uploaded = null;
  }
  program(gl, kind) { // one for each kind: branches cost time where there is no graphics card
    const program = gl.createProgram(), known = {};
    for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment(kind)]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return { program, at: (name) => (known[name] ??= gl.getUniformLocation(program, name)) };
  }
  listen() {
    const held = new Map(), canvas = this.canvas;
    const spread = () => {
      const [one, other] = held.values();
      return Math.hypot(one[0] - other[0], one[1] - other[1]);
    };
    canvas.addEventListener("pointerdown", (event) => {
      held.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const from = held.get(event.pointerId), apart = held.size === 2 && spread();
      if (!from) return;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      if (apart) this.zoomed(spread() / apart);
      else this.turned((event.clientX - from[0]) / 120, (event.clientY - from[1]) / 120);
    });
    const release = (event) => held.delete(event.pointerId);
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, release);
    canvas.addEventListener("wheel", (event) => {
      if (this.zoomed(Math.exp(-event.deltaY / 500))) event.preventDefault();
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.15], ArrowDown: [0, 0.15] };
      if (turn[event.key]) this.turned(turn[event.key][0], turn[event.key][1]);
      else if (event.key === "Home") this.look([0, 0]);
      else if ("+-=".includes(event.key)) this.zoomed(event.key === "-" ? 0.8 : 1.25);
      else return;
      event.preventDefault();
    });
    canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); this.gl = null; });
    canvas.addEventListener("webglcontextrestored", () => { this.begin(); this.draw(); });
    this.tools.addEventListener("click", (event) => {
      const act = hit(event, "[data-act]")?.dataset.act;
      if (act === "contact") this.look(towards(this.load));
      else if (act === "reset") this.reset();
      else if (act) this.zoomed(act === "-" ? 0.8 : 1.25);
    });
    this.tools.addEventListener("input", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.stage);
    new MutationObserver(() => this.draw()).observe(document.body, { attributeFilter: ["class"] }); // the theme
  }
  get load() { return this.data.loads[this.frame] || this.data.loads[0]; }
  show(place) {
    const data = (this.data = JSON.parse(place.dataset.viewer));
    place.dataset.ready = "yes";
    if (!this.gl && !this.programs) {
      place.insertAdjacentHTML("afterbegin", "<p class='quiet'>This browser has no WebGL 2, so there is no view in " +
        "three dimensions; the flat view shows the same numbers.</p>");
      return;
    }
    this.bytes = Uint8Array.from(atob(data.bytes), (letter) => letter.charCodeAt(0));
    this.canvas.setAttribute("aria-label", place.dataset.label);
    place.prepend(this.stage);
    place.append(this.tools);
    const shape = JSON.stringify([data.reach, data.radii, data.outline, data.rings]);
    if (shape !== this.shape) this.built = null;
    [this.shape, this.uploaded] = [shape, null];
    if (this.turn) this.draw();
    else this.reset();
  }
  look(turn) { this.turn = turn; this.draw(); }
  turned(yaw, pitch) { this.look([this.turn[0] + yaw, Math.max(-1.6, Math.min(1.6, this.turn[1] + pitch))]); }
  reset() {
    [this.zoom, this.section.value, this.ball.checked] = [1, "1", false];
    this.look(sum(towards(this.load), OBLIQUE));
  }
  zoomed(factor) {
    const zoom = Math.max(0.5, Math.min(8, this.zoom * factor)), changed = zoom !== this.zoom;
    this.zoom = zoom;
    this.draw();
    return changed;
  }
  draw() {
    this.waiting ??= requestAnimationFrame((now) => {
      const pause = now - this.last;
      [this.waiting, this.last] = [null, now];
      this.pace = pause < IDLE ? 0.7 * this.pace + 0.3 * pause : 16;
      this.paint(this.pace > 40 ? 0.6 : this.pace > 22 ? 1 : SHARP);
      clearTimeout(this.idle);
      this.idle = setTimeout(() => this.paint(SHARP), IDLE);
    });
  }
  upload(gl, { columns, rings }) {
    if (!this.built) {
      this.built = geometry(this.data);
      gl.bufferData(gl.ARRAY_BUFFER, this.built.vertices, gl.DYNAMIC_DRAW);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.built.indices, gl.STATIC_DRAW);
    }
    if (this.uploaded === this.frame) return;
    const count = columns * (rings + 1), field = new Uint8Array(2 * count); // value and presence of each cell
    for (let cell = 0; cell < count; cell++) {
      field[2 * cell] = this.bytes[this.frame * count + cell];
      field[2 * cell + 1] = field[2 * cell] ? 255 : 0;
    }
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG8, columns, rings + 1, 0, gl.RG, gl.UNSIGNED_BYTE, field);
    this.uploaded = this.frame;
  }
  move(gl, part, vertex) {
    const places = [];
    for (let row = 0; row <= part.rows; row++)
      for (let column = 0; column <= part.columns; column++)
        places.push(...vertex(row / part.rows, column / part.columns));
    gl.bufferSubData(gl.ARRAY_BUFFER, part.at, new Float32Array(places));
  }
  paint(sharpness) {
    const { gl, data, canvas } = this, side = Math.round(canvas.clientWidth * sharpness);
    const style = getComputedStyle(canvas);
    if (!gl || !data || !side) return;
    if (canvas.width !== side) canvas.width = canvas.height = side;
    gl.viewport(0, 0, side, side);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.upload(gl, data);
    const outer = data.radii[2], turn = rotation(this.turn);
    const [x, y, z] = normalised(data.loads[0]), wide = Math.hypot(x, y);
    const normal = wide > 1e-6 ? [y / wide, -x / wide, 0] : [0, -1, 0], distance = outer * Number(this.section.value);
    const length = data.sizes[this.frame], load = this.load;
    const across = normalised(cross(load, Math.abs(z) > 0.9 ? [1, 0, 0] : [0, 0, 1]));
    const hexadecimal = (name) => style.getPropertyValue(name).trim().match(/\w\w/g);
    const colour = (name) => hexadecimal(name).map((part) => parseInt(part, 16) / 255);
    for (const { program, at } of this.programs) {
      gl.useProgram(program);
      gl.uniformMatrix3fv(at("turn"), false, turn);
      gl.uniform1f(at("size"), (0.92 * this.zoom) / outer);
      gl.uniform1f(at("reach"), data.reach);
      gl.uniform1f(at("gain"), data.gain);
      gl.uniform1i(at("film"), Number(data.film));
      gl.uniform1i(at("solid"), Number(this.ball.checked));
      gl.uniform4fv(at("section"), [...normal, distance >= outer ? 9 : distance]);
      gl.uniform3fv(at("radii"), data.radii);
      gl.uniform3fv(at("behind"), colour("--backing"));
      gl.uniform3fv(at("sphere"), colour("--ball"));
    }
    for (const part of this.built.parts) {
      const shown = { [BALL]: this.ball.checked, [ARROW]: length > 0, [SECTION]: distance < outer };
      if (shown[part.kind] === false) continue;
      if (part.kind === ARROW) this.move(gl, part, arrow(load, length, [across, cross(load, across)]));
      if (part.kind === SECTION) this.move(gl, part, plane(normal, distance, outer));
      const { program, at } = this.programs[part.kind];
      gl.useProgram(program);
      gl.uniform3fv(at("colour"), colour(part.colour));
      if (part.kind === BALL) gl.enable(gl.BLEND);
      gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_SHORT, part.start * 2);
      gl.disable(gl.BLEND);
    }
    this.triad.innerHTML = Object.entries(data.axes).map(([name, axis]) => {
      const [right, up] = seen(turn, axis), [across, above] = [30 * right, -30 * up];
      const words = `<text x="${1.3 * across}" y="${1.3 * above + 4}" text-anchor="middle">${name}</text>`;
      return `<line x2="${across}" y2="${above}"/>${words}`;
    }).join("");
  }
}

const viewers = new Map(); // by name: a view keeps its turn, and its canvas, when its numbers change
/** Show a frame of the viewer in an element; the first call sets it up. @param {HTMLElement} place */
export function showFrame(place, number) {
  const { name } = place.dataset;
  if (!viewers.has(name)) viewers.set(name, new Viewer(name));
  const viewer = viewers.get(name);
  viewer.frame = number;
  if (place.dataset.ready) viewer.draw();
  else viewer.show(place);
}
document.addEventListener("shown", () => {
  const places = document.querySelectorAll(".viewer:not([data-ready], .player *)");
  for (const place of /** @type {NodeListOf<HTMLElement>} */ (places)) showFrame(place, 0);
});
