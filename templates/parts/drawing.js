// Draws on graph paper, or joint graphs. It fills the boxes of the page, which are handed in, and draws what is typed.
// The text area: figures/student_drawing.py. Lengths are mm on paper, y upwards; angles degrees.
document.querySelectorAll(".surface").forEach(place => {
"use strict";
const MOST = 20000, UNDOS = 200, FAR = 2000, { PI, abs, max, min, round } = Math;
const get = selector => place.querySelector(selector), every = selector => [...place.querySelectorAll(selector)];
const on = (node, names, act) => names.split(" ").map(name => node.addEventListener(name, act));
const data = JSON.parse(get("script").textContent), said = data.words, [wide, high] = data.mm, isGraph = data.kind === "graph";
const field = get("textarea"), svg = get("[data-surface]"), glass = get(".surface-glass"), told = get(".surface-told");
const [sheet, ink, over] = svg.querySelectorAll("g g"), pointers = new Map(), names = [...data.points, ...data.arrows];
let items = [], past = [], next = [], text = "", view, tool, snaps = true, coarse = false, keys = false, busy = false, picked = 0;
let start = null, cursor = null, marks = [], way, radius = 0, pair = null, pressed = null, drag = null, gauge = null, cuts = null, joined = 0;

const tidy = (value, digits = 4) => round(value * 10 ** digits) / 10 ** digits + 0;
const beyond = (c, a, d) => ({ x: c.x + d * Math.cos(a * PI / 180), y: c.y + d * Math.sin(a * PI / 180) });
const heading = (p, q) => Math.atan2(q.y - p.y, q.x - p.x) * 180 / PI, far = (p, q) => Math.hypot(q.x - p.x, q.y - p.y);
const along = (p, q, k) => ({ x: p.x + (q.x - p.x) * k, y: p.y + (q.y - p.y) * k }), half = a => a - 360 * Math.ceil((a - 180) / 360);
const xy = c => ({ x: c.x, y: c.y });
const numbers = typed => (typed.replace(/−/g, "-").match(/[-+]?\d+(?:[.,]\d+)?/g) || []).map(one => +one.replace(",", "."));
const product = typed => typed.split(/[*×]/).reduce((p, one) => p * numbers(one)[0] ** (/²|\^2/.test(one) ? 2 : 1), 1);
const print = (value, digits = 2) => String(tidy(value, digits)).replace(".", data.lang === "fr" ? "," : ".");
const near = (c, all, reach) => all.reduce((best, one) => (far(one, c) < (best ? far(best, c) : reach) ? one : best), null);
const find = id => items.find(one => one.id === id), of = (...kinds) => items.filter(one => kinds.includes(one.k));
const curves = () => of("line", "circle", "vector"), state = () => JSON.stringify(items);
const tell = says => { if (told.textContent !== says) told.textContent = says; };
function put(item) {
  for (const key of "xyar") if (key in item) item[key] = tidy(item[key]);
  items.push({ ...item, id: max(0, ...items.map(one => one.id)) + 1 });
  return items[items.length - 1];
}

// geometry
function curve(one) {
  if (one.k !== "vector") return one;
  const p = find(one.from), q = find(one.to);
  return { x: p.x, y: p.y, a: heading(p, q), length: far(p, q), q: q };
}
function foot(one, c) {
  const it = curve(one), d = far(it, c) || 1;
  if (it.r) return along(it, c, it.r / d);
  const s = d * Math.cos((heading(it, c) - it.a) * PI / 180);
  return beyond(it, it.a, it.q ? max(0, min(it.length, s)) : s);
}
// Two circles are cut by their common chord.
function cut(one, other) {
  let [p, q] = [curve(one), curve(other)].sort((a, b) => (a.r ? 1 : 0) - (b.r ? 1 : 0));
  if (p.r) {
    const d = far(p, q) || 1e-9;
    [p, q] = [{ ...along(p, q, (d * d + p.r * p.r - q.r * q.r) / (2 * d * d)), a: heading(p, q) + 90 }, p];
  }
  const u = beyond({ x: 0, y: 0 }, p.a, 1), dx = q.x - p.x, dy = q.y - p.y, s = dx * u.x + dy * u.y, off = dx * u.y - dy * u.x;
  const v = beyond({ x: 0, y: 0 }, q.a || 0, 1), sine = u.x * v.y - u.y * v.x, root = Math.sqrt(q.r * q.r - off * off);
  const ways = q.r ? [s - root, s + root] : [(dx * v.y - dy * v.x) / sine];
  return ways.map(k => beyond(p, p.a, k)).filter(c => abs(c.x) + abs(c.y) < FAR);
}
function crossings() {
  const all = curves().slice(-60);
  return (cuts = cuts || all.flatMap((one, k) => all.slice(k + 1).flatMap(other => cut(one, other))));
}

// view and snapping
const unit = () => view.w / (svg.clientWidth || 360), tall = () => unit() * (svg.clientHeight || 300);
function fit() {
  const edge = isGraph ? 2 : 9, share = (svg.clientWidth || 360) / (svg.clientHeight || 300);
  view = { w: max(wide + 2 * edge - 4, (high + 14) * share) };
  view = { ...view, x: (wide - 4 - view.w) / 2, y: (high - edge / 2 - tall()) / 2 };
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
  const point = near(c, of("point", "body").filter(one => one !== but), reach), cross = !but && near(c, crossings(), reach);
  if (point) return { ...xy(point), point, how: "point" };
  if (cross) return { ...cross, how: "cross" };
  const still = curves().filter(one => !but || ![one.id, one.from, one.to].includes(but.id));
  return near(c, still.map(one => ({ ...foot(one, c), on: one, how: "on" })), 0.7 * reach);
}
function snap(c, but) {
  const step = isGraph ? 2 : unit() > 1 / 12 ? 1 : unit() > 1 / 30 ? 0.5 : 0.1, reach = keys ? 0.02 : isGraph ? 6 : (coarse ? 14 : 9) * unit();
  if (!snaps) return { x: tidy(c.x, 2), y: tidy(c.y, 2) };
  const it = close(c, reach, but), d = start && it && it.how === "on" && !it.on.r && far(foot(it.on, start), start) < 0.01 && far(start, it);
  if (!it) return { x: tidy(round(c.x / step) * step), y: tidy(round(c.y / step) * step) };
  return d ? { ...it, ...along(start, it, round(2 * d / step) * step / 2 / d) } : it;
}
function hit(c) {
  const it = close(c, isGraph ? 6 : 22 * unit()), joint = isGraph && !it && near(c, of("joint").map(one => ({ ...middle(one), one })), 7);
  return it ? it.point || it.on : joint && joint.one;
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
  start = cuts = null;
  const now = JSON.stringify({ v: 1, items, scale: scale() || null, view: [view.x, view.y, view.w].map(one => tidy(one, 2)) });
  if (now.length > MOST && past.length) { items = JSON.parse(past.pop()); tell(said.full); return; }
  text = items.length ? now : "";
  send(field, text);
  if (!isTyped) fill();
  show();
}
function back(from, to) {
  if (!from.length) return;
  to.push(state());
  items = JSON.parse(from.pop());
  picked = 0;
  keep();
}
function remove(item) {
  if (!item) return;
  marks = []; picked = 0;
  change(() => { items = items.filter(one => one !== item && ![one.from, one.to, ...(one.of || [])].includes(item.id)); });
  tell(said.deleted);
}
function load() {
  text = field.value; picked = 0; start = cuts = null;
  try { items = text ? JSON.parse(text).items : []; show(); } catch { items = []; }
  take();
  show();
}

// boxes: of components, the line of cells.js
const box = name => document.querySelector(`[name="${data.own + name}"]`);
function send(to, value) {
  if (!to || to.value === value) return;
  to.value = value;
  busy = true; to.dispatchEvent(new Event("input", { bubbles: true })); busy = false;
}
const named = n => items.find(one => one.n === n && one.k !== "body"), isArrow = n => data.arrows.includes(n);
const scaled = () => (get("[data-scale][aria-pressed=true]") || {}).dataset, entry = name => get(`[data-in=${name}]`);
const scale = () => max(0, (scaled() && numbers(box(scaled().scale).value)[0]) || 0);
function value(one) {
  const p = find(one.from), q = find(one.to);
  return (p ? [q.x - p.x, q.y - p.y] : [one.x, one.y]).map(part => tidy(part, 2));
}
function read(name) {
  const all = numbers(box(name).value);
  return all.length === 2 && all.every(one => abs(one) < FAR) ? all : null;
}
function fill() {
  if (isGraph) {
    const joints = of("joint").map(one => called(one).replace(/–/g, "-"));
    if (joints.length || joined) send(box(data.box), joints.join(", "));
    joined = joints.length;
  }
  for (const n of names) {
    const one = named(n), texts = one ? value(one).map(part => print(part)) : [];
    if (String(read(n) || "") === String(one ? value(one) : "")) continue;
    send(box(n), one ? `(${texts.join(" ; ")})` : "");
  }
}
// Of an arrow its tip, from where it starts.
function take(only) {
  if (isGraph) takeGraph();
  for (const n of names) {
    const now = read(n), one = named(n);
    if (only && only !== n) continue;
    if (one && only && !box(n).value) delete one.n;
    if (!now || (one && String(value(one)) === String(now.map(part => tidy(part, 2))))) continue;
    cuts = null;
    if (!isArrow(n)) { if (one) [one.x, one.y] = now; else put({ k: "point", x: now[0], y: now[1], n }); continue; }
    const base = find((one || of("vector")[0] || {}).from) || put({ k: "point", x: wide / 2, y: high / 2 }), tip = put({ k: "point", x: base.x + now[0], y: base.y + now[1] });
    if (one) one.to = tip.id; else put({ k: "vector", from: base.id, to: tip.id, n });
  }
}

// tools
const dot = c => (c.point && find(c.point.id)) || near(c, of("point"), 0.005) || put({ k: "point", ...xy(c) });
const where = c => `x ${print(c.x)}  y ${print(c.y)}`, angle = () => way + (tool === "perpendicular" ? 90 : 0);
function size({ length, a }) {
  const long = length == null ? "" : `${print(length)} mm`, real = long && scale() ? ` = ${print(length * scale())} ${scaled().unit}` : "";
  return `${long}${real}${a == null ? "" : `  ∠ ${print(half(a), 1)}°`}`.trim().replace("-", "−");
}
function called(one) {
  if (one.k === "joint") return `${one.of.map(id => find(id).n).join("–")} ${kind(one.t)}`.trim();
  const name = (data.labels[one.n] || []).map(run => run[0]).join("") || (one.k === "body" ? one.n : said.things[one.k]);
  return `${name} ${one.k === "circle" ? `r ${print(one.r)} mm` : one.k === "line" || one.k === "vector" ? size(curve(one)) : where(one)}`;
}
function pick(item) { picked = item ? item.id : 0; if (item) tell(called(item)); show(); }
const make = item => pick(change(() => put(item)));
function measure(c) {
  const it = c.how === "on" ? curve(c.on) : null, [first] = marks, second = marks.length === 1 && !!first.it === !!it;
  marks = second ? [first, { ...c, it }] : [{ ...c, it }];
  if (it && it.r) gauge = { length: it.r };
  else if (it && second) { const a = abs(half(it.a - first.it.a)); gauge = { a: min(a, 180 - a) }; }
  else gauge = it || (second ? { length: far(first, c), a: heading(first, c) } : null);
  if (gauge) tell(size(gauge));
  show();
}
const measured = what => gauge && (what === "mm" ? gauge.length : what === "°" ? gauge.a && half(gauge.a) : scale() && what === scaled().unit ? gauge.length * scale() : undefined);
function ends(c, tap, made) {
  if (far(start, c) < 1e-6 || (tap && start.fresh)) { start.fresh = false; preview(c); } else made(start);
}
const release = {
  point: c => pick(c.point || change(() => dot(c))),
  intersection(c) { if (c.point || c.how === "cross") release.point(c); else tell(said.no_crossing); },
  vector: (c, tap) => ends(c, tap, from => {
    const made = change(() => put({ k: "vector", from: dot(from).id, to: dot(c).id }));
    pick(data.arrows.length ? made : find(made.to));
    tell(called(made));
  }),
  parallel(c) {
    if (c.how === "on" && !c.on.r) aim(curve(c.on).a);
    else if (way == null) tell(said.no_direction);
    else make({ k: "line", ...xy(c), a: half(angle()) });
  },
  perpendicular: c => release.parallel(c),
  compass(c, tap) {
    if (pair && pair.push(c) > 1) { radius = far(...pair); pair = null; entry("radius").value = print(radius); show(); }
    else if (pair) show();
    else if (radius > 0) make({ k: "circle", ...xy(c), r: radius });
    else ends(c, tap, from => make({ k: "circle", ...xy(from), r: far(from, c) }));
  },
  measure,
  move: c => pick(hit(c)),
  delete: c => remove(hit(c)),
  body(c) {
    const n = 1 + max(0, ...of("body").map(one => +one.n || 0));
    if (hit(c)) pick(hit(c)); else make({ k: "body", ...xy(c), n: `${n}` });
  },
  joint(c) {
    const there = near(c, of("body"), 6);
    if (there) marks = marks.includes(there.id) ? marks.filter(id => id !== there.id) : [...marks, there.id];
    show();
    tell(marks.map(id => find(id).n).join("–"));
  },
};
function press(c, e) {
  if (tool === "move" && e) { drag = { item: hit(c), from: at(e), before: state() }; picked = drag.item ? drag.item.id : 0; }
  else if ((tool === "vector" || (tool === "compass" && !(radius > 0) && !pair)) && !start) start = { ...c, fresh: true };
  preview(c);
}
function aim(a) { way = a; entry("direction").value = print(half(a)); show(); }
function choose(name) { tool = name; start = pair = gauge = null; marks = []; show(); }
function join(t) {
  if (marks.length < 2) { tell(said.two_bodies); return; }
  const bodies = marks;
  marks = [];
  make({ k: "joint", of: bodies, t });
}
function christen(n) {
  const item = find(picked), owner = named(n);
  if (!item || item.k !== (isArrow(n) ? "vector" : "point")) { if (owner) pick(owner); else tell(said.pick_first); return; }
  change(() => { if (owner) delete owner.n; if (owner !== item) item.n = n; });
  pick(item);
}
const acts = {
  undo: () => back(past, next),
  redo: () => back(next, past),
  zoom_in: () => zoom(1.6),
  zoom_out: () => zoom(1 / 1.6),
  fit() { fit(); render(); },
  snap() { snaps = !snaps; show(); },
  pair() { pair = []; radius = 0; show(); },
};
on(place, "click", e => {
  const it = e.target.closest("[data-tool], [data-act], [data-link], [data-name], [data-put], [data-scale], [data-joint]");
  if (!it) return;
  const { tool: name, act, link, name: n, put: to, joint } = it.dataset;
  if (acts[name || act]) acts[name || act]();
  else if (name) choose(name);
  else if (link) aim(+link);
  else if (n) christen(n);
  else if (joint) join(joint);
  else if (to) { send(box(to), print(measured(it.dataset.unit))); tell(box(to).value); }
  else { every("[data-scale]").forEach(one => one.setAttribute("aria-pressed", one === it)); entry("scale").value = box(it.dataset.scale).value; show(); }
});
on(place, "focusin", ({ target: t }) => { if (t.dataset.in && t.select) t.select(); });
on(place, "input", e => {
  const what = e.target.dataset.in, typed = e.target.value, item = find(picked), n = typed.replace(/[^\p{L}\p{N}_]/gu, "");
  if (!what) return;
  if (what === "scale") { send(box(scaled().scale), typed); keep(); }
  else if (what === "direction") { way = numbers(typed)[0]; show(); }
  else if (what === "radius") { radius = typed.split("/").map(product).reduce((p, q) => p / q); pair = null; show(); }
  else if (what === "kind") { join(typed); e.target.value = ""; }
  else if (item && n) { item.n = n; keep(); }
});

// keys, fingers, mouse
on(svg, "keydown", e => {
  const by = { Left: [-1, 0], Right: [1, 0], Up: [0, 1], Down: [0, -1] }[e.key.slice(5)], d = e.shiftKey ? 0.1 : 1;
  const c = cursor || centre(), taken = every("[data-tool]")[e.key - 1], stops = [...of("point", "body"), ...crossings()];
  keys = true;
  if (by) look({ x: tidy(c.x + by[0] * d), y: tidy(c.y + by[1] * d) });
  else if (e.key === "." && stops.length) look(stops[(stops.findIndex(one => far(one, c) < 1e-3) + 1) % stops.length]);
  else if (taken) { taken.click(); tell(taken.title); }
  else if (/^(Enter| )$/.test(e.key)) { const here = (snaps && close(c, 0.02)) || c; press(here); release[tool](here, true); }
  else if (e.key === "Escape") choose(tool);
  else if (e.key === "Delete") remove(find(picked));
  else if (/^[+-]$/.test(e.key)) zoom(1.6 ** `${e.key}1`);
  else if (e.ctrlKey && "zy".includes(e.key)) acts[e.key === "z" ? "undo" : "redo"]();
  else return;
  e.preventDefault();
});
function look(c) {
  const there = close(c, 0.02), { x, y } = centre();
  cursor = xy(c);
  if (abs(c.x - x) > view.w / 2) view.x += c.x - x;
  if (abs(c.y - y) > tall() / 2) view.y += c.y - y;
  render();
  tell(there && there.point ? called(there.point) : `${where(c)} ${there ? said.things[there.how] : ""}`);
}
function magnify(e) {
  const w = 60 * unit();
  if (!coarse || isGraph) return;
  glass.style.display = "block";
  glass.classList.toggle("right", e.offsetX < svg.clientWidth / 2);
  glass.setAttribute("viewBox", [cursor.x - w / 2, -cursor.y - w / 2, w, w].join(" "));
}
function finish() { pressed = drag = null; glass.style.display = "none"; }
function give_up() { if (start && start.fresh) start = null; finish(); preview(null); }
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
    const [s, t] = Array.from(pointers.values(), at), mid = along(p, q, 0.5), now = along(s, t, 0.5);
    view.x -= now.x - mid.x; view.y -= now.y - mid.y;
    zoom(far(s, t) / (far(p, q) || 1), mid);
  } else if (drag) { dragged(at(e)); magnify(e); }
  else if (pressed) { preview(cursor = snap(at(e))); magnify(e); }
});
function dragged(c) {
  const { item, from } = drag, isFree = item && ["point", "body"].includes(item.k), to = isFree ? snap(c, item) : c;
  drag.moved = true; cuts = null; cursor = to;
  if (!item) { view.x -= c.x - from.x; view.y -= c.y - from.y; }
  else if (item.k !== "vector" && item.k !== "joint") {
    [item.x, item.y] = isFree ? [tidy(to.x), tidy(to.y)] : [tidy(item.x + c.x - from.x), tidy(item.y + c.y - from.y)];
    drag.from = c;
    tell(called(item));
  }
  render();
}
on(svg, "pointerup pointercancel", e => {
  if (!pointers.delete(e.pointerId) || !pressed || pointers.size) return;
  const isTap = far(e, pressed) < 9, was = drag;
  if (e.type !== "pointerup") { give_up(); return; }
  finish();
  if (!was) release[tool](cursor = snap(at(e)), isTap);
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
const path = (d, kind) => draw("path", { d, class: kind }), ring = (c, r, kind) => draw("circle", { cx: c.x, cy: -c.y, r, class: kind });
const line = (p, q, kind) => path(`M${p.x} ${-p.y}L${q.x} ${-q.y}`, kind), endless = (c, a, kind) => line(beyond(c, a, -FAR), beyond(c, a, FAR), kind);
function head(p, q, kind) {
  const [s, t] = [155, 205].map(by => beyond(q, heading(p, q) + by, 11 * unit()));
  return [line(p, q, kind), path(`M${s.x} ${-s.y}L${q.x} ${-q.y}L${t.x} ${-t.y}Z`, `${kind} tip`)];
}
function write(runs, c, font, kind = "") {
  let before = 0;
  return draw("text", { x: c.x, y: -c.y, "font-size": font, class: kind }, ...runs.map(([letters, italic, share = 1, rise = 0]) => {
    const dy = (before - rise) * font;
    before = rise;
    return draw("tspan", { dy, "font-size": share * font, "font-style": italic ? "italic" : "normal" }, letters);
  }));
}
const shapes = {
  line: (one, kind_) => [endless(one, one.a, `${kind_} thin`)],
  circle: (one, kind_) => [ring(one, one.r, `${kind_} thin`), ring(one, 1.5 * unit(), kind_)],
  vector(one, kind_, runs, s) { const it = curve(one); return [...head(it, it.q, kind_), write(runs, beyond(along(it, it.q, 0.5), it.a + 90, 10 * s), 15 * s)]; },
  point: (one, kind_, runs, s) => [ring(one, 4 * s, `${kind_} dot`), write(runs, { x: one.x + 7 * s, y: one.y + 7 * s }, 16 * s)],
  body: (one, kind_) => [ring(one, 5, `${kind_} vertex`), write([[one.n]], { x: one.x, y: one.y - 1.7 }, 5, "mid")],
  joint(one, kind_) { const c = middle(one); return [...one.of.map(id => line(c, find(id), kind_)), write([[kind(one.t).slice(0, 3)]], { x: c.x, y: c.y + 1 }, 4, "mid")]; },
};
function render() {
  if (!svg.clientWidth) return;
  svg.setAttribute("viewBox", [view.x, -view.y - tall(), view.w, tall()].join(" "));
  svg.classList.toggle("coarse-grid", unit() > 0.38);
  svg.style.setProperty("--unit", unit());
  ink.replaceChildren(...[...of("joint"), ...items.filter(one => one.k !== "joint")].flatMap(one => shapes[one.k](one, one.id === picked || marks.includes(one.id) ? "ink picked" : "ink", data.labels[one.n] || [], unit())));
  const taken = [];  // a name makes way for those before it
  for (const name of ink.querySelectorAll("text:not(.mid)")) {
    const b = name.getBBox(), { y, height: h } = b;
    for (const k of [1, -1, 2, -2, 3, -3, 0]) if (taken.some(o => abs(o.y - b.y) < h && o.x < b.x + b.width && b.x < o.x + o.width)) b.y = y + k * h;
    name.y.baseVal[0].value += b.y - y;
    taken.push(b);
  }
  preview(pressed || (keys && document.activeElement === svg) ? cursor : null);
}
function preview(c) {
  const s = unit(), arm = 40 * s, all = [...marks, ...(pair || []), start].filter(one => one && one.x !== undefined).map(one => ring(one, 7 * s, "ghost"));
  if (c) {
    const shape = { point: "M-9 0a9 9 0 1 0 0-1z", cross: "M-7-7h14v14h-14z", on: "M0-8 8 0 0 8-8 0z" }[c.how] || "M-6 0h12M0-6v12";
    all.push(path(`M${c.x} ${-c.y - arm}v${2 * arm}M${c.x - arm} ${-c.y}h${2 * arm}`, "hair"), draw("path", { d: shape, transform: `translate(${c.x} ${-c.y}) scale(${s})`, class: "catch" }));
    if (start && tool === "vector") all.push(...head(start, c, "ghost"));
    if (tool === "compass" && (start || radius > 0)) all.push(ring(start || c, radius > 0 ? radius : far(start, c), "ghost"));
    if (/^p(ar|er)/.test(tool) && way !== undefined) all.push(endless(c, angle(), "ghost"));
    if (pressed || start) tell(start && far(start, c) ? size({ length: far(start, c), a: heading(start, c) }) : where(c));
  }
  over.replaceChildren(...all);
}
function show() {
  const item = find(picked), pressed_ = {
    "tool]:not([data-tool$=do]": it => it.tool === tool, "act=snap]": () => snaps, "act=pair]": () => !!pair,
    "link]": it => way === +it.link, "name]": it => !!item && named(it.name) === item,
  };
  for (const [selector, is] of Object.entries(pressed_)) every(`[data-${selector}`).forEach(one => one.setAttribute("aria-pressed", is(one.dataset)));
  every("[data-for]").forEach(one => { one.hidden = !one.matches(`[data-for~=${tool}]`); });
  every("[data-name]").forEach(one => one.classList.toggle("placed", !!named(one.dataset.name)));
  every("[data-put]").forEach(one => { one.hidden = measured(one.dataset.unit) == null; });
  get("[data-tool=undo]").disabled = !past.length; get("[data-tool=redo]").disabled = !next.length;
  if (isGraph) { entry("body").closest("label").hidden = !item || item.k !== "body"; if (item && item.n) entry("body").value = item.n; }
  else get("output").textContent = gauge ? size(gauge) : "";
  render();
}

// joint graphs
const kind = t => (data.kinds[t] || [""])[0];
const middle = one => one.of.map(find).reduce((c, b, k, all) => along(c, b, 1 / (k + 1)));
function takeGraph() {
  const pieces = box(data.box).value.split(/[,;\n]+/).filter(one => one.trim()), joints = pieces.map(piece => {
    const parts = /^[\s*]*([\p{L}\p{N}]+(?:\s*[-–/]\s*[\p{L}\p{N}]+)+)\s*:?\s*(.*?)\s*\.?$/u.exec(piece);
    return parts && { of: parts[1].split(/\s*[-–/]\s*/), t: parts[2] ? Object.keys(data.kinds).find(t => data.kinds[t].includes(parts[2].toLowerCase())) : "" };
  });
  const drawn_ = of("joint").map(one => ({ of: one.of.map(id => find(id).n), t: one.t }));
  if (joints.some(one => !one || one.t === undefined) || JSON.stringify(joints) === JSON.stringify(drawn_)) return;
  items = of("body");
  [...new Set(joints.flatMap(one => one.of))].forEach((n, k, all) => {
    const c = beyond({ x: 0.5, y: 0.5 }, 90 - 360 * k / all.length, 0.38);
    if (!items.some(one => one.n === n)) put({ k: "body", x: wide * c.x, y: high * c.y, n });
  });
  for (const one of joints) put({ k: "joint", of: one.of.map(n => of("body").find(b => b.n === n).id), t: one.t });
  joined = joints.length;
}

// begins
function hear(name) {
  const n = [...names, ...data.scales, data.box].find(one => data.own + one === name), before = state();
  if (busy || !n) return;
  if (!data.scales.includes(n)) take(n); else if (scaled().scale === n) entry("scale").value = box(n).value;
  if (before !== state()) remember(before);
  keep(true);
}
on(document, "input", e => hear(e.target.name));
on(document, "kept:changed answers:filled", ({ target, detail }) => {
  if (busy) return;
  if (field.value !== text) load();
  else if (detail) queueMicrotask(() => hear((target.dataset.keepOwn || "") + detail.name));
});
const paper = place.previousElementSibling;
place.hidden = false;
if (paper && paper.matches(".paper")) {
  paper.classList.add("drawn");
  sheet.append(draw("g", { transform: `translate(0 ${-high})` }, ...Array.from(paper.querySelectorAll("svg > g"), one => one.cloneNode(true))));
}
if (entry("scale")) entry("scale").value = box(scaled().scale).value;
fit();
tool = get("[data-tool]").dataset.tool;
load();
new ResizeObserver(render).observe(svg);
});
