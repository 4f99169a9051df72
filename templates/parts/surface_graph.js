// Joint graphs on a surface: bodies, and joints between two or more of them.
(window.surfaces ||= {}).graph = s => {
"use strict";
const { data, said, line, ring, write, beyond, along, far, near, find, of, put, hit, pick, make, tell, show, box, send, entry, keep } = s;
let joined = 0;
const kind = t => (data.kinds[t] || [""])[0];
// Places of the names of joints: in the middle, or where lines cross there beside it.
function places() {
  const taken = [];
  for (const one of of("joint")) {
    const [p, q, ...more] = one.of.map(find), middle = [p, q, ...more].reduce((c, b, k) => along(c, b, 1 / (k + 1)));
    const beside = more.length ? [] : [0.35, 0.65, 0.25, 0.75].map(k => along(p, q, k));
    const free = [middle, ...beside].find(c => !near(c, [...taken, ...of("body")], 7));
    taken.push({ ...free || middle, one });
  }
  return taken;
}
const called = one => (one.k === "body" ? one.n : `${one.of.map(id => find(id).n).join("–")} ${kind(one.t)}`.trim());
function join(t) {
  if (s.marks.length < 2) { tell(said.two_bodies); return; }
  const bodies = s.marks;
  s.marks = [];
  make({ k: "joint", of: bodies, t });
}
function take() {
  const [wide, high] = data.mm, pieces = box(data.box).value.split(/[,;\n]+/).filter(one => one.trim()), joints = pieces.map(piece => {
    const parts = /^[\s*]*([\p{L}\p{N}]+(?:\s*[-–/]\s*[\p{L}\p{N}]+)+)\s*:?\s*(.*?)\s*\.?$/u.exec(piece);
    return parts && { of: parts[1].split(/\s*[-–/]\s*/), t: parts[2] ? Object.keys(data.kinds).find(t => data.kinds[t].includes(parts[2].toLowerCase())) : "" };
  });
  const drawn = of("joint").map(one => ({ of: one.of.map(id => find(id).n), t: one.t }));
  if (joints.some(one => !one || one.t === undefined) || JSON.stringify(joints) === JSON.stringify(drawn)) return;
  s.items = of("body");
  const names = [...new Set(joints.flatMap(one => one.of))], isNew = !s.items.length;
  const around = share => { const c = beyond({ x: 0.5, y: 0.5 }, 90 - 360 * share, 0.38); return { x: wide * c.x, y: high * c.y }; };
  const ways = [...Array(24).keys()].map(k => around(k / 24)), room = c => Math.min(...s.items.map(one => far(one, c)));
  names.forEach((n, k) => {  // one more body where the others leave most room
    const c = isNew ? around(k / names.length) : ways.reduce((best, one) => (room(one) > room(best) ? one : best));
    if (!s.items.some(one => one.n === n)) put({ k: "body", ...c, n });
  });
  for (const one of joints) put({ k: "joint", of: one.of.map(n => of("body").find(b => b.n === n).id), t: one.t });
  joined = joints.length;
}
return {
  edge: 2, boxes: [data.box], called, take,
  step: () => 2,
  reach: () => 6,
  hit: c => (near(c, places(), 7) || {}).one,
  fill() {
    const joints = of("joint").map(one => called(one).replace(/–/g, "-"));
    if (joints.length || joined) send(box(data.box), joints.join(", "));
    joined = joints.length;
  },
  tools: {
    body(c) {
      const n = 1 + Math.max(0, ...of("body").map(one => +one.n || 0));
      if (hit(c)) pick(hit(c)); else make({ k: "body", ...c, n: `${n}` });
    },
    joint(c) {
      const there = near(c, of("body"), 6);
      if (there) s.marks = s.marks.includes(there.id) ? s.marks.filter(id => id !== there.id) : [...s.marks, there.id];
      show();
      tell(s.marks.map(id => find(id).n).join("–"));
    },
  },
  clicks: { joint: join },
  inputs: {
    kind(typed) { join(typed); entry("kind").value = ""; },
    body(typed) {
      const item = find(s.picked), n = typed.replace(/[^\p{L}\p{N}_]/gu, "");
      if (item && n) { item.n = n; keep(); }
    },
  },
  shapes: {
    body: (one, look) => [ring(one, 5, `${look} vertex`), write([[one.n]], { x: one.x, y: one.y - 1.7 }, 5, "mid")],
    joint(one, look) { const c = places().find(each => each.one === one); return [...one.of.map(id => line(c, find(id), look)), write([[kind(one.t).slice(0, 3)]], { x: c.x, y: c.y + 1 }, 4, "mid")]; },
  },
  shown(item) {
    entry("body").closest("label").hidden = !item || item.k !== "body";
    if (item && item.n) entry("body").value = item.n;
  },
};
};
