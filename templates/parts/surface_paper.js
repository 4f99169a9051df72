// Graph paper on a surface: points, vectors, lines and circles, constructed as with set-square and compass.
(window.surfaces ||= {}).paper = s => {
"use strict";
const { PI, abs, max, min, round } = Math, FAR = 2000, { data, said, get, every, tidy, print, where, beyond, along, far, heading, near, xy, unit } = s;
const { find, of, put, pick, make, change, tell, show, keep, preview, box, send, entry, draw, line, ring, path, write } = s;
const [wide, high] = data.mm, names = [...data.points, ...data.arrows], [sheet, ink] = s.layers;
let way, radius = 0, pair = null, gauge = null, scaled = get("[data-scale]");

const half = a => a - 360 * Math.ceil((a - 180) / 360), curves = () => of("line", "circle", "vector");
const numbers = typed => (typed.replace(/−/g, "-").match(/[-+]?\d+(?:[.,]\d+)?/g) || []).map(one => +one.replace(",", "."));
const product = typed => typed.split(/[*×]/).reduce((p, one) => p * numbers(one)[0] ** (/²|\^2/.test(one) ? 2 : 1), 1);

// geometry
const span = (p, q) => ({ length: far(p, q), a: heading(p, q) });
function curve(one) {
  const p = find(one.from), q = find(one.to);
  return p ? { ...xy(p), ...span(p, q), q } : one;
}
function foot(one, c) {
  const it = curve(one), d = far(it, c) || 1;
  if (it.r) return along(it, c, it.r / d);
  const t = d * Math.cos((heading(it, c) - it.a) * PI / 180);
  return beyond(it, it.a, it.q ? max(0, min(it.length, t)) : t);
}
// Two circles are cut by their common chord.
function cut(one, other) {
  let [p, q] = [curve(one), curve(other)].sort((a, b) => (a.r ? 1 : 0) - (b.r ? 1 : 0));
  if (p.r) {
    const d = far(p, q) || 1e-9;
    [p, q] = [{ ...along(p, q, (d * d + p.r * p.r - q.r * q.r) / (2 * d * d)), a: heading(p, q) + 90 }, p];
  }
  const [u, v] = [p, q].map(one => beyond({ x: 0, y: 0 }, one.a || 0, 1)), dx = q.x - p.x, dy = q.y - p.y, t = dx * u.x + dy * u.y, off = dx * u.y - dy * u.x;
  const sine = u.x * v.y - u.y * v.x, root = Math.sqrt(q.r * q.r - off * off);
  const ways = q.r ? [t - root, t + root] : [(dx * v.y - dy * v.x) / sine];
  return ways.map(k => beyond(p, p.a, k)).filter(c => abs(c.x) + abs(c.y) < FAR);
}
function crossings() {
  const all = curves().slice(-60);
  return (s.cuts = s.cuts || all.flatMap((one, k) => all.slice(k + 1).flatMap(other => cut(one, other))));
}
function close(c, reach, but) {
  const cross = !but && near(c, crossings(), reach);
  if (cross) return { ...cross, how: "cross" };
  const still = curves().filter(one => !but || ![one.id, one.from, one.to].includes(but.id));
  return near(c, still.map(one => ({ ...foot(one, c), on: one, how: "on" })), 0.7 * reach);
}
// Along a line, lengths from where one started are round.
function laid(it, step) {
  const start = s.start, d = start && it.how === "on" && !it.on.r && far(foot(it.on, start), start) < 0.01 && far(start, it);
  return d ? { ...it, ...along(start, it, round(2 * d / step) * step / 2 / d) } : it;
}

// boxes
const named = n => s.items.find(one => one.n === n), isArrow = n => data.arrows.includes(n);
const scale = () => max(0, (scaled && numbers(box(scaled.dataset.scale).value)[0]) || 0);
function value(one) {
  const p = find(one.from), q = find(one.to);
  return (p ? [q.x - p.x, q.y - p.y] : [one.x, one.y]).map(part => tidy(part, 2));
}
function read(name) {
  const all = numbers(box(name).value);
  return all.length === 2 && all.every(one => abs(one) < FAR) ? all : null;
}
function fill() {
  for (const n of names) {
    const one = named(n), is = one ? value(one) : "";
    if (String(read(n) || "") !== String(is)) send(box(n), is && `(${is.map(part => print(part)).join(" ; ")})`);
  }
}
// Of an arrow its tip, from where it starts.
function take(only) {
  if (data.scales.includes(only)) { if (scaled.dataset.scale === only) entry("scale").value = box(only).value; return; }
  for (const n of names) {
    const now = read(n), one = named(n);
    if (only && only !== n) continue;
    if (one && only && !box(n).value) delete one.n;
    if (!now || (one && String(value(one)) === String(now.map(part => tidy(part, 2))))) continue;
    s.cuts = null;
    const point = (x, y, more) => put({ k: "point", x, y, ...more });
    if (!isArrow(n)) { if (one) [one.x, one.y] = now; else point(...now, { n }); continue; }
    const base = find((one || of("vector")[0] || {}).from) || point(wide / 2, high / 2), tip = point(base.x + now[0], base.y + now[1]);
    if (one) one.to = tip.id; else put({ k: "vector", from: base.id, to: tip.id, n });
  }
}

// tools
const dot = c => (c.point && find(c.point.id)) || near(c, of("point"), 0.005) || put({ k: "point", ...xy(c) });
const angle = () => way + (s.tool === "perpendicular" ? 90 : 0);
function size({ length, a }) {
  const long = length == null ? "" : `${print(length)} mm`, real = long && scale() ? ` = ${print(length * scale())} ${scaled.dataset.unit}` : "";
  return `${long}${real}${a == null ? "" : `  ∠ ${print(half(a), 1)}°`}`.trim().replace("-", "−");
}
function called(one) {
  const name = (data.labels[one.n] || []).map(run => run[0]).join("") || said.things[one.k];
  return `${name} ${one.k === "circle" ? `r ${print(one.r)} mm` : one.k === "point" ? where(one) : size(curve(one))}`;
}
function measure(c) {
  const it = c.how === "on" ? curve(c.on) : null, [first] = s.marks, second = s.marks.length === 1 && !!first.it === !!it;
  s.marks = second ? [first, { ...c, it }] : [{ ...c, it }];
  if (it && it.r) gauge = { length: it.r };
  else if (it && second) { const a = abs(half(it.a - first.it.a)); gauge = { a: min(a, 180 - a) }; }
  else gauge = it || (second ? span(first, c) : null);
  if (gauge) tell(size(gauge));
  show();
}
const measured = what => gauge && { [scale() && scaled.dataset.unit]: gauge.length && gauge.length * scale(), mm: gauge.length, "°": gauge.a && half(gauge.a) }[what];
function ends(c, tap, made) {
  const { start } = s;
  if (far(start, c) < 1e-6 || (tap && start.fresh)) { start.fresh = false; preview(c); } else made(start);
}
const tools = {
  point: c => pick(c.point || change(() => dot(c))),
  intersection(c) { if (c.point || c.how === "cross") tools.point(c); else tell(said.no_crossing); },
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
  perpendicular: c => tools.parallel(c),
  compass(c, tap) {
    if (pair && pair.push(c) > 1) { radius = far(...pair); pair = null; entry("radius").value = print(radius); show(); }
    else if (pair) show();
    else if (radius > 0) make({ k: "circle", ...xy(c), r: radius });
    else ends(c, tap, from => make({ k: "circle", ...xy(from), r: far(from, c) }));
  },
  measure,
};
function aim(a) { way = a; entry("direction").value = print(half(a)); show(); }
function christen(n) {
  const item = find(s.picked), owner = named(n);
  if (!item || item.k !== (isArrow(n) ? "vector" : "point")) return owner ? pick(owner) : tell(said.pick_first);
  change(() => { if (owner) delete owner.n; if (owner !== item) item.n = n; });
  pick(item);
}

// what is seen
const endless = (c, a, look) => line(beyond(c, a, -FAR), beyond(c, a, FAR), look);
function head(p, q, look) {
  const [t, u] = [155, 205].map(by => beyond(q, heading(p, q) + by, 11 * unit()));
  return [line(p, q, look), path(`M${t.x} ${-t.y}L${q.x} ${-q.y}L${u.x} ${-u.y}Z`, `${look} tip`)];
}
function ghosts(c) {
  const { start, tool } = s, all = [...s.marks, ...(pair || []), start].filter(Boolean).map(one => ring(one, 7 * unit(), "ghost"));
  if (!c) return all;
  if (start && tool === "vector") all.push(...head(start, c, "ghost"));
  if (tool === "compass" && (start || radius > 0)) all.push(ring(start || c, radius > 0 ? radius : far(start, c), "ghost"));
  if (/^p(ar|er)/.test(tool) && way !== undefined) all.push(endless(c, angle(), "ghost"));
  return all;
}
function rendered() {
  const apart = [10, 20, 50, 100].find(mm => mm > 34 * unit());
  for (const mark of sheet.querySelectorAll("text")) mark.style.display = +mark.textContent % apart ? "none" : "";
  part(ink.querySelectorAll("text"));
}
// A name makes way for those before it.
function part(names) {
  const taken = [];
  for (const name of names) {
    const b = name.getBBox(), { y, height: h } = b;
    for (const k of [1, -1, 2, -2, 3, -3, 4, -4, 0]) if (taken.some(o => abs(o.y - b.y) < h && o.x < b.x + b.width && b.x < o.x + o.width)) b.y = y + k * h;
    name.y.baseVal[0].value += b.y - y;
    taken.push(b);
  }
}

const printed = s.place.previousElementSibling;
printed.classList.add("drawn");
sheet.append(draw("g", { transform: `translate(0 ${-high})` }, ...Array.from(printed.querySelectorAll("svg > g"), one => one.cloneNode(true))));
if (entry("scale")) entry("scale").value = box(scaled.dataset.scale).value;
return {
  edge: wide > 200 ? wide / 12 : 10, isFine: true, boxes: [...names, ...data.scales], called, take, fill, scale, close, laid, tools, ghosts, rendered, stops: crossings,
  step: () => (unit() > 1 / 12 ? 1 : unit() > 1 / 30 ? 0.5 : 0.1),
  reach: px => px * unit(),
  press(c) { if ((s.tool === "vector" || (s.tool === "compass" && !(radius > 0) && !pair)) && !s.start) s.start = { ...c, fresh: true }; },
  reading: c => (s.start && far(s.start, c) ? size(span(s.start, c)) : where(c)),
  chosen() { pair = gauge = null; },
  clicks: {
    link(degrees) { aim(+degrees); },
    name: christen,
    pair() { pair = []; radius = 0; show(); },
    put(n, node) {  // once more: the other sign
      const { unit } = node.dataset, to = box(n), is = print(measured(unit));
      send(to, to.value === is && unit !== "°" ? `-${is}` : is);
      tell(`${node.textContent.replace(/[\s→]/g, "")} = ${to.value.replace("-", "−")} ${unit}`);
    },
    scale(n, node) { scaled = node; entry("scale").value = box(n).value; show(); },
  },
  inputs: {
    scale(typed) { send(box(scaled.dataset.scale), typed); keep(); },
    direction(typed) { way = numbers(typed)[0]; show(); },
    radius(typed) { radius = typed.split("/").map(product).reduce((p, q) => p / q); pair = null; show(); },
  },
  shapes: {
    line: (one, look) => [endless(one, one.a, `${look} thin`)],
    circle: (one, look) => [ring(one, one.r, `${look} thin`), ring(one, 1.5 * unit(), look)],
    vector(one, look, runs, k) { const it = curve(one); return [...head(it, it.q, look), write(runs, beyond(along(it, it.q, 0.5), it.a + 90, 10 * k), 15 * k)]; },
    point: (one, look, runs, k) => [ring(one, 4 * k, `${look} dot`), write(runs, { x: one.x + 7 * k, y: one.y + 7 * k }, 16 * k)],
  },
  pressed: { "pair]": () => !!pair, "link]": it => way === +it.link, "scale]": it => it === scaled.dataset, "name]": (it, item) => !!item && named(it.name) === item },
  shown() {
    part(every(".surface-links text"));
    every("[data-name]").forEach(one => one.classList.toggle("placed", !!named(one.dataset.name)));
    every("[data-put]").forEach(one => { one.hidden = measured(one.dataset.unit) == null; });
    get("output").textContent = gauge ? size(gauge) : "";
  },
};
};
