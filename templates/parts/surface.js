// A surface to draw on, of a kind whose script is before this: it fills the boxes of the page, and draws what is typed.
// The text area: figures/student_drawing.py. Lengths are mm on paper, y upwards; angles degrees.
document.querySelectorAll(".surface").forEach(place => {
"use strict";
const MOST = 20000, UNDOS = 200, { PI, abs, max, min, round } = Math;
const get = selector => place.querySelector(selector), every = selector => [...place.querySelectorAll(selector)];
const on = (node, names, act) => names.split(" ").map(name => node.addEventListener(name, act));
const data = JSON.parse(get("script").textContent), said = data.words, [wide, high] = data.mm;
const field = get("textarea"), svg = get("[data-surface]"), glass = get(".surface-glass"), told = get(".surface-told");
const layers = svg.querySelectorAll("g g"), [, ink, over] = layers, pointers = new Map();
const s = { items: [], marks: [], picked: 0, start: null, cuts: null, tool: get("[data-tool]").dataset.tool };  // shared with the kind
let past = [], next = [], text = "", view, snaps = true, coarse = false, keys = false, busy = false, cursor = null, pressed = null, drag = null;

const tidy = (value, digits = 4) => round(value * 10 ** digits) / 10 ** digits + 0;
const beyond = (c, a, d) => ({ x: c.x + d * Math.cos(a * PI / 180), y: c.y + d * Math.sin(a * PI / 180) });
const heading = (p, q) => Math.atan2(q.y - p.y, q.x - p.x) * 180 / PI, far = (p, q) => Math.hypot(q.x - p.x, q.y - p.y);
const along = (p, q, k) => ({ x: p.x + (q.x - p.x) * k, y: p.y + (q.y - p.y) * k }), xy = c => ({ x: c.x, y: c.y });
const print = (value, digits = 2) => String(tidy(value, digits)).replace(".", data.lang === "fr" ? "," : ".");
const where = c => `x ${print(c.x)}  y ${print(c.y)}`;
const near = (c, all, reach) => all.reduce((best, one) => (far(one, c) < (best ? far(best, c) : reach) ? one : best), null);
const find = id => s.items.find(one => one.id === id), of = (...kinds) => s.items.filter(one => kinds.includes(one.k));
const dots = () => of("point", "body"), state = () => JSON.stringify(s.items);
const tell = says => { if (told.textContent !== says) told.textContent = says; };
function put(item) {
  for (const key of "xyar") if (key in item) item[key] = tidy(item[key]);
  s.items.push({ ...item, id: max(0, ...s.items.map(one => one.id)) + 1 });
  return s.items[s.items.length - 1];
}

// view and snapping
const unit = () => view.w / (svg.clientWidth || 360), tall = () => unit() * (svg.clientHeight || 300);
function fit() {
  const share = (svg.clientWidth || 360) / (svg.clientHeight || 300);
  view = { w: max(wide + 2 * own.edge - 4, (high + 14) * share) };
  view = { ...view, x: (wide - 4 - view.w) / 2, y: (high - own.edge / 2 - tall()) / 2 };
}
const centre = () => ({ x: round(view.x + view.w / 2), y: round(view.y + tall() / 2) });
function zoom(by, c = cursor || centre()) {
  const w = min(600, max(8, view.w / by));
  view = { ...along(c, view, w / view.w), w };
  render();
}
function at(e) {
  const room = svg.getBoundingClientRect();
  return { x: view.x + (e.x - room.left) * unit(), y: view.y + (room.bottom - e.y) * unit() };
}
// ``but`` is what moves.
function close(c, reach, but) {
  const point = near(c, dots().filter(one => one !== but), reach);
  return point ? { ...xy(point), point, how: "point" } : own.close(c, reach, but);
}
function snap(c, but) {
  const step = own.step(), it = snaps && close(c, keys ? 0.02 : own.reach(coarse ? 14 : 9), but);
  if (it) return own.laid(it, step);
  return snaps ? { x: tidy(round(c.x / step) * step), y: tidy(round(c.y / step) * step) } : { x: tidy(c.x, 2), y: tidy(c.y, 2) };
}
function hit(c) {
  const it = close(c, own.reach(22));
  return it ? it.point || it.on : own.hit(c);
}

// changing
function remember(before) { past = [...past, before].slice(-UNDOS); next = []; }
function change(how) {
  remember(state());
  const made = how();
  keep();
  return made;
}
function keep(isTyped) {
  s.start = s.cuts = null;
  const now = JSON.stringify({ v: 1, items: s.items, scale: own.scale() || null, view: [view.x, view.y, view.w].map(one => tidy(one, 2)) });
  if (now.length > MOST && past.length) { s.items = JSON.parse(past.pop()); tell(said.full); return; }
  text = s.items.length ? now : "";
  send(field, text);
  if (!isTyped) own.fill();
  show();
}
function back(from, to) {
  if (!from.length) return;
  to.push(state());
  s.items = JSON.parse(from.pop());
  s.picked = 0;
  keep();
}
function remove(item) {
  if (!item) { tell(said.nothing_here); return; }
  s.marks = []; s.picked = 0;
  change(() => { s.items = s.items.filter(one => one !== item && ![one.from, one.to, ...(one.of || [])].includes(item.id)); });
  tell(said.deleted);
}
function load() {
  text = field.value; s.picked = 0; s.start = s.cuts = null;
  try { s.items = text ? JSON.parse(text).items : []; show(); } catch { s.items = []; }
  own.take();
  show();
}

// boxes: of components, the line of cells.js
const box = name => document.querySelector(`[name="${data.own + name}"]`), entry = name => get(`[data-in=${name}]`);
function send(to, value) {
  if (!to || to.value === value) return;
  to.value = value;
  busy = true; to.dispatchEvent(new Event("input", { bubbles: true })); busy = false;
}
function hear(name) {
  const n = own.boxes.find(one => data.own + one === name), before = state();
  if (busy || !n) return;
  own.take(n);
  if (before !== state()) remember(before);
  keep(true);
}

// tools
function pick(item) { s.picked = item ? item.id : 0; if (item) tell(own.called(item)); show(); }
const make = item => pick(change(() => put(item)));
function press(c, e) {
  if (s.tool === "move" && e) { drag = { item: hit(c), from: at(e), before: state() }; s.picked = drag.item ? drag.item.id : 0; }
  else own.press(c);
  preview(c);
}
function choose(name) { s.tool = name; s.start = null; s.marks = []; own.chosen(); show(); }
const acts = {
  undo: () => back(past, next),
  redo: () => back(next, past),
  zoom_in: () => zoom(1.6),
  zoom_out: () => zoom(1 / 1.6),
  fit() { fit(); render(); },
  snap() { snaps = !snaps; show(); },
};
on(place, "click", ({ target }) => {
  const whats = Object.keys(own.clicks), node = target.closest(["tool", "act", ...whats].map(one => `[data-${one}]`).join());
  if (!node) return;
  const { tool, act } = node.dataset, what = whats.find(one => one in node.dataset);
  if (what) own.clicks[what](node.dataset[what], node);
  else if (acts[tool || act]) acts[tool || act]();
  else choose(tool);
});
on(place, "focusin", ({ target: t }) => { if (t.dataset.in && t.select) t.select(); });
on(place, "input", ({ target: t }) => { if (t.dataset.in) own.inputs[t.dataset.in](t.value); });

// keys, fingers, mouse
on(svg, "keydown", e => {
  const by = { Left: [-1, 0], Right: [1, 0], Up: [0, 1], Down: [0, -1] }[e.key.slice(5)], d = e.shiftKey ? 0.1 : 1;
  const c = cursor || centre(), taken = every("[data-tool]")[e.key - 1], turn = { ".": 1, ",": -1 }[e.key];
  keys = true;
  if (by) look({ x: tidy(c.x + by[0] * d), y: tidy(c.y + by[1] * d) });
  else if (turn) next_stop(c, turn);
  else if (taken) { taken.click(); tell(taken.title); }
  else if (/^(Enter| )$/.test(e.key)) { const here = (snaps && close(c, 0.02)) || c; press(here); release[s.tool](here, true); }
  else if (e.key === "Escape") choose(s.tool);
  else if (e.key === "Delete") remove(find(s.picked));
  else if (/^[+-]$/.test(e.key)) zoom(1.6 ** `${e.key}1`);
  else if (e.ctrlKey && "zy".includes(e.key)) acts[e.key === "z" ? "undo" : "redo"]();
  else return;
  e.preventDefault();
});
function next_stop(c, turn) {
  const place_of = (one, all) => all.findIndex(other => far(one, other) < 1e-3);
  const stops = [...dots(), ...own.stops()].filter((one, k, all) => place_of(one, all) === k);
  if (stops.length) look(stops.at((place_of(c, stops) + turn) % stops.length));
}
function look(c) {
  const there = close(c, 0.02), { x, y } = centre();
  cursor = xy(c);
  if (abs(c.x - x) > view.w / 2) view.x += c.x - x;
  if (abs(c.y - y) > tall() / 2) view.y += c.y - y;
  render();
  tell(there && there.point ? own.called(there.point) : `${where(c)} ${there ? said.things[there.how] : ""}`);
}
function magnify(e) {
  const w = 60 * unit();
  if (!coarse || !own.isFine) return;
  glass.style.display = "block";
  glass.classList.toggle("right", e.offsetX < svg.clientWidth / 2);
  glass.setAttribute("viewBox", [cursor.x - w / 2, -cursor.y - w / 2, w, w].join(" "));
}
function finish() { pressed = drag = null; glass.style.display = "none"; }
function give_up() { if (s.start && s.start.fresh) s.start = null; finish(); preview(null); }
on(svg, "pointerdown", e => {
  if (e.button) return;
  svg.focus({ preventScroll: true });
  svg.setPointerCapture(e.pointerId);
  coarse = e.pointerType !== "mouse"; keys = false;
  pointers.set(e.pointerId, e);
  if (pointers.size > 1) { give_up(); return; }
  cursor = snap(at(e)); pressed = e;
  press(cursor, e);
  magnify(e);
});
on(svg, "pointermove", e => {
  if (!pointers.has(e.pointerId)) { coarse = keys = false; preview(snap(at(e))); return; }
  const [p, q] = Array.from(pointers.values(), at);
  pointers.set(e.pointerId, e);
  if (q) {
    const [t, u] = Array.from(pointers.values(), at), mid = along(p, q, 0.5), now = along(t, u, 0.5);
    view.x -= now.x - mid.x; view.y -= now.y - mid.y;
    zoom(far(t, u) / (far(p, q) || 1), mid);
  } else if (drag) { dragged(at(e)); magnify(e); }
  else if (pressed) { preview(cursor = snap(at(e))); magnify(e); }
});
function dragged(c) {
  const { item, from } = drag, isFree = dots().includes(item), to = isFree ? snap(c, item) : c;
  drag.moved = true; s.cuts = null; cursor = to;
  if (!item) { view.x -= c.x - from.x; view.y -= c.y - from.y; }
  else if ("x" in item) {
    [item.x, item.y] = isFree ? [tidy(to.x), tidy(to.y)] : [tidy(item.x + c.x - from.x), tidy(item.y + c.y - from.y)];
    drag.from = c;
    tell(own.called(item));
  }
  render();
}
on(svg, "pointerup pointercancel", e => {
  if (!pointers.delete(e.pointerId) || !pressed || pointers.size) return;
  const isTap = far(e, pressed) < 9, was = drag;
  if (e.type !== "pointerup") { give_up(); return; }
  finish();
  if (!was) release[s.tool](cursor = snap(at(e)), isTap);
  else if (was.item && was.moved) { remember(was.before); keep(); } else show();
});
on(svg, "wheel", e => {
  if (document.activeElement !== svg && !e.ctrlKey) return;
  e.preventDefault();
  zoom(2 ** (-e.deltaY / 300), at(e));
});

// what is seen
function draw(name, attributes, ...inside) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, is] of Object.entries(attributes)) node.setAttribute(key, is);
  node.append(...inside);
  return node;
}
const path = (d, look) => draw("path", { d, class: look }), ring = (c, r, look) => draw("circle", { cx: c.x, cy: -c.y, r, class: look });
const line = (p, q, look) => path(`M${p.x} ${-p.y}L${q.x} ${-q.y}`, look);
function write(runs, c, font, look = "") {
  let before = 0;
  return draw("text", { x: c.x, y: -c.y, "font-size": font, class: look }, ...runs.map(([letters, italic, share = 1, rise = 0]) => {
    const dy = (before - rise) * font;
    before = rise;
    return draw("tspan", { dy, "font-size": share * font, "font-style": italic ? "italic" : "normal" }, letters);
  }));
}
function render() {
  if (!svg.clientWidth) return;
  svg.setAttribute("viewBox", [view.x, -view.y - tall(), view.w, tall()].join(" "));
  svg.classList.toggle("coarse-grid", unit() > 0.38);
  svg.style.setProperty("--unit", unit());
  const beneath = of("joint"), isPicked = one => one.id === s.picked || s.marks.includes(one.id);
  ink.replaceChildren(...[...beneath, ...s.items.filter(one => !beneath.includes(one))].flatMap(one => own.shapes[one.k](one, isPicked(one) ? "ink picked" : "ink", data.labels[one.n] || [], unit())));
  own.rendered();
  preview(pressed || (keys && document.activeElement === svg) ? cursor : null);
}
function preview(c) {
  const k = unit(), arm = 40 * k, all = own.ghosts(c);
  if (c) {
    const shape = { point: "M-9 0a9 9 0 1 0 0-1z", cross: "M-7-7h14v14h-14z", on: "M0-8 8 0 0 8-8 0z" }[c.how] || "M-6 0h12M0-6v12";
    all.push(path(`M${c.x} ${-c.y - arm}v${2 * arm}M${c.x - arm} ${-c.y}h${2 * arm}`, "hair"), draw("path", { d: shape, transform: `translate(${c.x} ${-c.y}) scale(${k})`, class: "catch" }));
    if (pressed || s.start) tell(own.reading(c));
  }
  over.replaceChildren(...all);
}
function show() {
  const item = find(s.picked), states = { "tool]:not([data-tool$=do]": it => it.tool === s.tool, "act=snap]": () => snaps, ...own.pressed };
  for (const [selector, is] of Object.entries(states)) every(`[data-${selector}`).forEach(one => one.setAttribute("aria-pressed", is(one.dataset, item)));
  every("[data-for]").forEach(one => { one.hidden = !one.matches(`[data-for~=${s.tool}]`); });
  get("[data-tool=undo]").ariaDisabled = !past.length; get("[data-tool=redo]").ariaDisabled = !next.length;
  own.shown(item);
  render();
}

// begins
Object.assign(s, { place, data, said, layers, get, every, tidy, print, where, beyond, along, far, heading, near, xy, unit, find, of, put, hit, pick, make, change, tell, show, keep, preview, box, send, entry, draw, path, ring, line, write });
const nothing = () => null, own = {
  close: nothing, hit: nothing, scale: nothing, press: nothing, chosen: nothing, rendered: nothing, laid: it => it, stops: () => [], ghosts: () => [], reading: where,
  ...window.surfaces[data.kind](s),
};
const release = { move: c => pick(hit(c)), delete: c => remove(hit(c)), ...own.tools };
on(document, "input", e => hear(e.target.name));
on(document, "kept:changed answers:filled", ({ target, detail }) => {
  if (busy) return;
  if (field.value !== text) load();
  else if (detail) queueMicrotask(() => hear((target.dataset.keepOwn || "") + detail.name));
});
place.hidden = false;
fit();
load();
new ResizeObserver(render).observe(svg);
});
