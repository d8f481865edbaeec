// @ts-check
// The connection to the server: one request at a time, one pending edit per field, and a new start after every loss.
const SLOW = 100; // ms after the oldest request without an answer, until the answers are marked as updating
const TICK = 100, PING = 400, SILENT = 2000, DEAD = 10000, HANDSHAKE = 4000, MAX_PAUSE = 3000; // ms
/**
 * @typedef {{key: string, since: number, gesture?: any, n?: number, words: Record<string, any>}} Request
 * @typedef {Record<string, any>} Message
 */
const page = document.body;
/** @type {Set<(message: Message, request: Request | null) => void>} */
const handlers = new Set();
/** @type {Map<string, Request>} */
const pending = new Map(); // by action and name: the latest request that has not been sent
/** @type {Message} */
const latest = {}; // values by name, to which the server sends changes
/** @type {WebSocket | null} */
let socket = null;
/** @type {Request | null} */
let current = null; // the request that the server is to answer
let open = false, number = 0, question = -1;
let pause = TICK, started = 0, pinged = 0, heard = 0, slow = 0, presses = 0, pressed = false;

addEventListener("pointerdown", () => { pressed = true; presses += 1; }, true);
for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => { pressed = false; }, true);

/** Ask the server; a later request of the same action and name replaces one that waits. @param {any} value */
export function ask(action, name = "", value = "", more = {}) {
  const key = `${action} ${name}`;
  const since = (pending.get(key) || { since: performance.now() }).since;
  pending.set(key, { key, since, gesture: pressed ? presses : key, words: { do: action, name, value, ...more } });
  send();
}
/** Return the value that a field is to have: that of its latest edit, or undefined without one. */
export function pendingValue(name) {
  const key = `edit ${name}`;
  return (pending.get(key) || (current?.key === key ? current : undefined))?.words.value;
}
export const isPending = (key) => pending.has(key);
export const withdraw = () => pending.clear();
/** Call a function with each message, and the request that it answers; null for none. */
export function listen(handler) { handlers.add(handler); }

function send() {
  page.dataset.idle = pending.size || current ? "no" : "yes";
  if (open && !current && pending.size) {
    const [key, request] = pending.entries().next().value;
    pending.delete(key);
    submit(request);
  }
  mark();
}
function submit(request) {
  current = { ...request, n: ++number };
  socket.send(JSON.stringify({ n: number, ...request.words }));
}
function mark() {
  clearTimeout(slow);
  const oldest = Math.min(...[current, ...pending.values()].filter(Boolean).map((request) => request.since));
  const left = oldest + SLOW - performance.now();
  if (left > 0) delete page.dataset.updating;
  else page.dataset.updating = "yes";
  if (left > 0 && left <= SLOW) slow = setTimeout(mark, left);
}
/** Return a value after its changes: another one as a list, or changes by key or index. @returns {any} */
function changed(value, changes) {
  if (Array.isArray(changes)) return changes[0];
  const next = Array.isArray(value) ? [...value] : { ...value };
  for (const [key, inside] of Object.entries(changes)) next[key] = changed(next[key], inside);
  return next;
}
function receive(text) {
  const message = JSON.parse(text);
  pinged = 0;
  heard = performance.now();
  if (open) delete page.dataset.lost;
  if (message.pong) return;
  if (message.fresh) question = -1;
  if (message.question < question) return; // its changes are not those of the values here
  question = message.question;
  for (const [name, changes] of Object.entries(message.changes ?? {})) message[name] = changed(latest[name], changes);
  Object.assign(latest, message);
  const answered = current && message.n === current.n ? current : null;
  if (answered) finish(answered);
  for (const handler of handlers) handler(message, answered);
  send();
}
function finish(request) {
  current = null;
  if (open || request.words.do !== "open") return;
  open = true;
  pause = TICK;
  delete page.dataset.lost;
}
function connect() {
  const own = (socket = new WebSocket(new URL("socket", location.href.replace(/^http/, "ws"))));
  started = performance.now();
  own.onopen = () => {
    if (own !== socket) return;
    heard = performance.now();
    submit({ key: "start", since: heard, words: { do: "open", query: location.search.slice(1) } });
  };
  own.onmessage = (event) => { if (own === socket) receive(event.data); };
  own.onclose = () => { if (own === socket) reconnect(); };
}
function reconnect() {
  const lost = socket;
  socket = null;
  if (lost) lost.close();
  if (current && current.key !== "start" && !pending.has(current.key)) {
    const rest = [...pending];
    pending.clear();
    pending.set(current.key, current);
    for (const [key, request] of rest) pending.set(key, request);
  }
  clearTimeout(slow);
  current = null;
  open = false;
  pinged = 0;
  page.dataset.lost = "yes";
  setTimeout(connect, pause);
  pause = Math.min(MAX_PAUSE, 1.6 * pause);
}
setInterval(() => {
  const now = performance.now();
  if (!socket) return;
  if (socket.readyState !== WebSocket.OPEN) {
    if (now - started > HANDSHAKE) reconnect();
  } else if (pinged && now - pinged > DEAD) reconnect();
  else if (pinged && now - heard > SILENT) page.dataset.lost = "yes";
  else if (!pinged && now - heard > PING) {
    pinged = now;
    socket.send(JSON.stringify({ n: 0, do: "ping" }));
  }
}, TICK);
addEventListener("DOMContentLoaded", connect);
