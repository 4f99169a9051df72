// Draws a linkage, and writes it as the text of its file: points, bars and plates, slides, wheels, a jack, a load, the driver: a bar,
// the jack, or a slide on the ground (by). Millimetres, y upwards; lengths are rounded to 5 mm and angles to 5°. What is drawn stays in the text's first line, which a page that is opened again reads.
(function () {
  "use strict";
  const place = document.querySelector(".draw");
  if (!place) return;
  const MARK = "# drawing: ", HIGH = 320, LETTERS = "ABCDEFGHKLMNPQRSTUVWXYZ", FIXED = "OCDFGHKLMNPQRSTUVWXYZABE", STEP = 5;
  const said = JSON.parse(place.dataset.said), svg = place.querySelector("svg"), told = place.querySelector(".told");
  const area = () => document.getElementById("mechanism-text"), [boxX, boxY] = place.querySelectorAll("input");
  let now = { points: {}, bodies: [], slides: [] }, past = [], ahead = [], tool = "ground", marks = [], held = "";

  const round = (value, step = STEP) => Math.round(value / step) * step || 0;
  const at = (name) => now.points[name], far = (p, q) => Math.hypot(q.x - p.x, q.y - p.y);
  const heading = (p, q) => Math.atan2(q.y - p.y, q.x - p.x) * 180 / Math.PI;
  const half = (a) => round(a - 360 * Math.ceil((a - 180) / 360));
  const copy = (one) => JSON.parse(JSON.stringify(one)), tell = (text) => { told.textContent = text; };

  // --- what is near
  const unit = () => 480 / (svg.clientWidth || 480);
  function point(c, reach = 18 * unit()) {
    return Object.keys(now.points).reduce((best, n) => (far(at(n), c) < (best ? far(at(best), c) : reach) ? n : best), "");
  }
  function gap(p, q, c) {
    const d = far(p, q) || 1, s = Math.max(0, Math.min(1, ((c.x - p.x) * (q.x - p.x) + (c.y - p.y) * (q.y - p.y)) / d / d));
    return far({ x: p.x + s * (q.x - p.x), y: p.y + s * (q.y - p.y) }, c);
  }
  const away = (body, c) => Math.min(...body.map((n, k) => gap(at(n), at(body[(k + 1) % body.length]), c)));
  function bodyAt(c, reach = 14) {
    const near = now.bodies.map((body, k) => [away(body, c), k]).filter(([d]) => d < reach * unit()).sort((a, b) => a[0] - b[0]);
    return near.length ? near[0][1] : -1;
  }

  // --- changing
  function change(act) {
    const before = copy(now);
    act();
    const first = now.bodies.findIndex((body) => body.length === 2 && body.some((n) => at(n).g));
    if (!drives() && first >= 0) now.driver = first;
    if (now.bodies.length > 1 && !drives()) tell(said[first < 0 && !Object.values(now.points).some((c) => c.g) ? "no_ground" : "no_driver"]);
    keep(before);
    render();
  }
  const drives = () => now.driver >= 0 || now.jack || now.by;
  function keep(before) {
    if (JSON.stringify(before) === JSON.stringify(now)) return;
    past.push({ before, text: area().value });
    ahead = [];
    write(before);
  }
  // One step back, or again forwards; a text that nobody drew comes back as it was.
  function step(from, to) {
    if (!from.length) return;
    const { before, text } = from.pop(), left = now;
    to.push({ before: now, text: area().value });
    [now, marks, held] = [before, [], ""];
    if (text.startsWith(MARK)) write(left);
    else put(text);
    render();
  }
  // A new end that is tapped on a body belongs to it.
  function end(c) {
    const near = point(c), body = near ? -1 : bodyAt(c, 8), name = near || create(c);
    if (name && body >= 0) {
      now.bodies[body].push(name);
      tell(said.joined.replace("{0}", ranked(now).indexOf(body) + 2));
    }
    return name;
  }
  function create(c, g) {
    const name = [...(g ? FIXED : LETTERS)].find((n) => !(n in now.points));
    if (!name) { tell(said.full); return ""; }
    now.points[name] = { x: round(c.x), y: round(c.y), ...(g ? { g: 1 } : {}) };
    return name;
  }
  function remove(c) {
    const name = point(c), body = bodyAt(c), jack = now.jack;
    if (name) {
      delete now.points[name];
      now.bodies = now.bodies.map((one) => one.filter((n) => n !== name));
      now.slides = now.slides.filter((one) => one.p !== name);
      if (jack && jack.includes(name)) delete now.jack;
      if (now.load && now.load.p === name) delete now.load;
    } else if (body >= 0) now.bodies[body] = [];
    else if (jack && gap(at(jack[0]), at(jack[1]), c) < 14 * unit()) delete now.jack;
    const gone = (k) => !now.bodies[k] || now.bodies[k].length < 2;
    now.slides = now.slides.filter((one) => one.on === undefined || !gone(one.on));
    const kept = now.bodies.map((_, k) => k).filter((k) => !gone(k));
    now.slides.forEach((one) => { if (one.on !== undefined) one.on = kept.indexOf(one.on); });
    if (now.gears) now.gears = now.gears.filter((pair) => !pair.some(gone)).map((pair) => pair.map((k) => kept.indexOf(k)));
    if (now.load && now.load.on >= 0 && (now.load.on = kept.indexOf(now.load.on)) < 0) delete now.load;
    if (now.by && !rails(now).some((one) => one.p === now.by)) delete now.by;
    now.driver = kept.indexOf(now.driver);
    now.bodies = kept.map((k) => now.bodies[k]);
  }
  const rails = (state) => state.slides.filter((one) => one.on === undefined);
  // One thing drives.
  function drive(what) {
    delete now.jack;
    delete now.by;
    now.driver = -1;
    Object.assign(now, what);
  }
  function join() {
    const body = [...new Set(marks)];
    marks = [];
    if (body.every((n) => at(n).g)) tell(said.frame);
    else now.bodies.push(body);
  }
  const acts = {
    ground(c) {
      const name = point(c);
      change(() => { if (!name) create(c, true); else if (at(name).g) delete at(name).g; else at(name).g = 1; });
    },
    point(c) {
      const body = bodyAt(c);
      if (point(c)) return;
      change(() => { const name = create(c); if (name && body >= 0) now.bodies[body].push(name); });
    },
    bar(c) {
      change(() => {
        const name = end(c);
        if (name && !marks.includes(name)) marks.push(name);
        if (marks.length === 2) join();
      });
    },
    plate(c) {
      change(() => {
        const name = end(c);
        if (marks.length > 2 && name === marks[0]) join();
        else if (name && !marks.includes(name)) marks.push(name);
      });
    },
    slide(c) {
      const name = marks[0], on = bodyAt(c), near = point(c);
      if (!name) { marks = near ? [near] : []; render(); return; }
      marks = [];
      change(() => {
        now.slides = now.slides.filter((one) => one.p !== name);
        const held = on >= 0 && now.bodies[on].includes(name);
        if (held && now.bodies[on].length > 2) now.bodies[on] = now.bodies[on].filter((n) => n !== name);
        if (on >= 0 && !now.bodies[on].includes(name) && !near) now.slides.push({ p: name, on });
        else now.slides.push({ p: name, a: half(heading(at(name), c)) });
      });
    },
    driver(c) {
      const k = bodyAt(c), name = point(c);
      if (rails(now).some((one) => one.p === name)) change(() => drive({ by: name }));
      else if (k < 0 || !now.bodies[k].some((n) => at(n).g)) tell(said.no_driver);
      else change(() => drive({ driver: k }));
    },
    jack(c) {
      change(() => {
        const name = end(c);
        if (name && !marks.includes(name)) marks.push(name);
        if (marks.length === 2) { drive({ jack: marks }); marks = []; }
      });
    },
    gear(c) {
      const k = bodyAt(c);
      if (k < 0 || !pivot(now, k)) { tell(said.no_gear); return; }
      if (!marks.length) { marks = [k]; tell(said.gear_too); return; }
      const pair = [marks[0], k], same = (one) => one.every((n) => pair.includes(n));
      marks = [];
      tell(said.gear);
      if (pair[0] !== k) change(() => { const all = now.gears || []; now.gears = all.some(same) ? all.filter((one) => !same(one)) : [...all, pair]; });
    },
    load(c) {
      const name = marks[0], near = point(c), k = bodyAt(c);
      marks = [];
      if (name) change(() => { now.load = { p: name, a: half(heading(at(name), c)) }; });
      else if (near) { marks = [near]; render(); }
      else if (k >= 0) change(() => { if (now.load && now.load.on === k) delete now.load; else now.load = { on: k }; });
    },
    move(c) {
      const near = point(c), name = held;
      if (name && (!near || near === name) && far(at(name), c) > STEP) change(() => { held = ""; Object.assign(at(name), { x: round(c.x), y: round(c.y) }); });
      else { held = near; render(); }
    },
    delete(c) { change(() => remove(c)); },
  };

  // --- text
  const ranked = (state) => state.bodies.map((_, k) => k).sort((a, b) => (b === state.driver) - (a === state.driver) || a - b);
  const pivot = (state, k) => (state.bodies[k] || []).find((n) => state.points[n].g);
  function compose(state) {
    const given = new Map(), ground = [], bodies = [], slides = [], sides = [], turns = [], P = state.points;
    const put = (name, value, u = "mm") => { given.set(name, `${name} = "${value} ${u}"`); return name; };
    const order = ranked(state);
    const drive = state.bodies[state.driver] || [], hub = pivot(state, state.driver), slid = rails(state).find((one) => one.p === state.by);
    const origin = P[hub || Object.keys(P).find((n) => P[n].g)] || { x: 0, y: 0 };
    const number = (k) => order.indexOf(k) + 2, first = (body) => body.find((n) => P[n].g) || body[0];
    for (const [n, c] of Object.entries(P)) {
      if (!c.g) continue;
      const place = [["x", c.x - origin.x], ["y", c.y - origin.y]].map(([axis, v]) => `"${v ? put(axis + n, v) : "0 mm"}"`);
      ground.push(`${n} = [${place.join(", ")}]`);
    }
    for (const k of order) {
      const body = state.bodies[k], start = k === state.driver ? hub : first(body), [next, ...rest] = body.filter((n) => n !== start);
      const axis = heading(P[start], P[next]), j = number(k);
      const others = [`${next} = "${put(`r${j}`, Math.max(STEP, round(far(P[start], P[next]))))}"`];
      for (const n of rest) {
        const turn = half(heading(P[start], P[n]) - axis), r = put(`r${j}${n}`, Math.max(STEP, round(far(P[start], P[n]))));
        others.push(turn ? `${n} = { r = "${r}", angle = "${put(`beta${j}${n}`, turn, "deg")}" }` : `${n} = "${r}"`);
      }
      if (k !== state.driver) turns.push(`theta${j}`);
      bodies.push(`${j} = { at = "${start}"${k === state.driver ? ', angle = "theta2"' : ""}, points = { ${others.join(", ")} } }`);
    }
    state.slides.forEach((one, k) => {
      const j = state.bodies.length + 2 + k, c = P[one.p], distance = `s_${one.p}`;
      bodies.push(`${j} = { points = { ${one.p} = "0 mm" } }`);
      const x = one.a % 180 ? c.x - origin.x : 0, y = (one.a + 90) % 180 ? c.y - origin.y : 0;
      const way = one.on === undefined ? `on = "ground", through = ["${x} mm", "${y} mm"], along = "${one.a} deg"`
        : `on = "${number(one.on)}", through = "${first(state.bodies[one.on])}"`;
      slides.push(`${one.p} = { of = "${j}", ${way}, distance = "${distance}" }`);
    });
    const J = state.bodies.length + state.slides.length + 2, length = state.jack ? round(far(P[state.jack[0]], P[state.jack[1]])) : 0;
    const jacks = state.jack ? [`${J} = { from = "${state.jack[0]}", to = "${state.jack[1]}", rod = "${J + 1}", length = "L" }`] : [];
    const gears = (state.gears || []).map((pair, k) => {
      const apart = far(P[pivot(state, pair[0])], P[pivot(state, pair[1])]), wheels = pair.map((n) => put(`R${number(n)}`, Math.max(STEP, round(apart / 2))));
      return `G${k || ""} = { first = "${number(pair[0])}", second = "${number(pair[1])}", carrier = "ground", radii = ["${wheels.join('", "')}"] }`;
    });
    // A pair of bodies from points that stand already: of two ways to close it, the drawn one. A jack counts as a bar.
    const bars = state.jack ? [...state.bodies, state.jack] : state.bodies, left = new Set([...order, ...(state.jack ? [state.bodies.length] : [])]);
    const placed = new Set([...Object.keys(P).filter((n) => P[n].g), ...(slid ? [slid.p] : [])]);
    const settle = (...all) => all.forEach((k) => { left.delete(k); bars[k].forEach((n) => placed.add(n)); });
    if (drive.length) settle(state.driver);
    for (const pair of state.gears || []) if (pair.includes(state.driver)) settle(...pair);
    for (let tries = left.size + 1; tries; tries -= 1) {
      for (const k of left) {
        const body = bars[k], start = body.find((n) => placed.has(n));
        if (!start) continue;
        const rail = state.slides.find((one) => one.on === undefined && body.includes(one.p) && !placed.has(one.p));
        const guide = state.slides.find((one) => one.on === k && placed.has(one.p));
        if (rail) {
          const a = (heading(P[start], P[rail.p]) - rail.a) * Math.PI / 180;
          sides.push(`${rail.p} = "${Math.cos(a) < 0 ? "behind" : "ahead of"} ${start}"`);
          settle(k);
        } else if (guide) settle(k);
        else {
          const mate = [...left].find((m) => m !== k && bars[m].some((n) => placed.has(n)) && bars[m].some((n) => body.includes(n) && !placed.has(n)));
          if (mate === undefined) continue;
          const inner = bars[mate].find((n) => body.includes(n) && !placed.has(n)), end = bars[mate].find((n) => placed.has(n));
          const [p, q, b] = [P[start], P[end], P[inner]], cross = (q.x - p.x) * (b.y - p.y) - (q.y - p.y) * (b.x - p.x);
          sides.push(`${inner} = "${cross < 0 ? "right" : "left"} of ${start} -> ${end}"`);
          settle(k, mate);
        }
      }
    }
    // What is left closes all together, from where it is drawn.
    const open = new Set([...left].flatMap((k) => bars[k]).filter((n) => !placed.has(n)));
    if (open.size) {
      const from = drive.length ? `angle = "${half(heading(origin, P[drive.find((n) => n !== hub)]))} deg"` : `length = "${slid ? along(state, slid, origin) : length} mm"`;
      sides.push(`near = { ${[from, ...[...open].map((n) => `${n} = ["${P[n].x - origin.x} mm", "${P[n].y - origin.y} mm"]`)].join(", ")} }`);
    }
    const ranged = (name, value, out) => given.set(name, `${name} = { from = "${value - out} mm", to = "${value + out} mm", step = "5 mm" }`);
    const fast = slid ? `s_${slid.p}_dot` : "L_dot";
    if (state.jack) ranged("L", length, Math.max(STEP, round(length / 10)));
    else if (slid) ranged(`s_${slid.p}`, along(state, slid, origin), 40);
    if (state.jack || slid) given.set(fast, `${fast} = "80 mm/s"`);
    else {
      given.set("theta2", 'theta2 = { from = "-175 deg", to = "180 deg", step = "5 deg" }');
      given.set("omega2", 'omega2 = "10 rad/s"');
    }
    const asked = [...turns, ...state.slides.filter((one) => one !== slid).map((one) => `s_${one.p}`)], list = (all) => all.map((n) => `"${n}"`).join(", ");
    const rates = asked.map((n) => (n.startsWith("theta") ? n.replace("theta", "omega") : `${n}_dot`));
    const ask = asked.length ? `positions = [${list(asked)}]\nvelocities = [${list(rates)}]` : "mobility = true", weight = state.load;
    const load = weight && `${state.jack || slid ? "thrust" : "torque"} = { load = { ${weight.p ? `on = "${weight.p}", force = "100 N", angle = "${weight.a} deg"` : `on = "${number(weight.on)}", moment = "20 N*m"`} } }`;
    const tables = [["ground", ground], ["bodies", bodies], ["slides", slides], ["jacks", jacks], ["gears", gears], ["assembly", sides]].filter(([, all]) => all.length);
    return { given, ask: `[ask]\n${ask}\n`, load: load || "", tables: tables.map(([name, all]) => `[${name}]\n${all.join("\n")}\n`).join("\n"), shape: asked.join() + Object.keys(P) };
  }
  // Where a slide on the ground is drawn, along it.
  function along(state, one, origin) {
    const c = state.points[one.p];
    if (one.a % 180 === 0) return Math.cos(one.a * Math.PI / 180) * (c.x - origin.x);
    return (one.a + 90) % 180 === 0 ? Math.sin(one.a * Math.PI / 180) * (c.y - origin.y) : 0;
  }
  // What the boxes, or a hand, have changed stays where the drawing has not.
  function write(before) {
    const text = area().value, line = (name) => (text.match(new RegExp(`^${name} *=.*$`, "m")) || [""])[0];
    const head = `${MARK}${JSON.stringify(now)}\n${line("title") || said.untitled}\n`;
    if (!now.bodies.length) {
      if (text.startsWith(MARK)) put(head);
      return;
    }
    const was = compose(before), is = compose(now);
    const given = [...is.given].map(([name, says]) => (was.given.get(name) === says && line(name)) || says);
    const same = was.shape === is.shape;
    let ask = (same && (text.match(/^\[ask\][^]*$/m) || [""])[0]) || is.ask;
    if (!same || was.load !== is.load) ask = [...ask.split("\n").filter((one) => one && !/^(torque|thrust) *=/.test(one)), is.load, ""].filter((one, k, all) => one || k === all.length - 1).join("\n");
    if (same && line("require")) given.push(line("require"));
    put(`${head}\n[given]\n${given.join("\n")}\n\n${is.tables}\n${ask}`);
  }
  function put(text) {
    area().value = text;
    area().dispatchEvent(new Event("input", { bubbles: true }));
  }
  function read() {
    const line = area().value.split("\n", 1)[0];
    try { if (line.startsWith(MARK)) now = JSON.parse(line.slice(MARK.length)); } catch { tell(said.unreadable); }
  }

  // --- picture
  function piece(tag, about, text) {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    Object.entries(about).forEach(([name, value]) => node.setAttribute(name, value));
    if (text) node.textContent = text;
    svg.append(node);
  }
  function render() {
    svg.replaceChildren();
    for (let k = 20; k < 480; k += 20) piece("path", { d: `M${k} 0V${HIGH}M0 ${k}H480`, stroke: "#ddd", "stroke-width": 0.5 });
    const y = (c) => HIGH - c.y;
    for (const one of now.slides) {
      const c = at(one.p), turn = one.on === undefined ? one.a : heading(at(now.bodies[one.on][0]), at(now.bodies[one.on][1]));
      if (one.on === undefined) piece("path", { d: "M-60 0H60", transform: `translate(${c.x} ${y(c)}) rotate(${-turn})`, stroke: "#777", "stroke-width": 1.5, "stroke-dasharray": "6 4" });
      piece("rect", { x: -12, y: -7, width: 24, height: 14, fill: "#fff", stroke: one.p === now.by ? "#0a58a8" : "#000", "stroke-width": 1.5, transform: `translate(${c.x} ${y(c)}) rotate(${-turn})` });
    }
    now.bodies.forEach((body, k) => piece("polygon", {
      points: body.map((n) => `${at(n).x},${y(at(n))}`).join(" "), stroke: k === now.driver ? "#0a58a8" : "#000", "stroke-width": k === now.driver ? 5 : 3.5,
      "stroke-linejoin": "round", fill: "#0002" }));
    ranked(now).forEach((k, rank) => {
      const body = now.bodies[k].map(at), mean = (axis) => body.reduce((sum, c) => sum + c[axis], 0) / body.length, c = { x: mean("x"), y: mean("y") };
      piece("text", { x: c.x, y: y(c) + 5, "font-size": 14, "text-anchor": "middle", fill: "#333", stroke: "#fff", "stroke-width": 6, "paint-order": "stroke" }, rank + 2);
    });
    for (const pair of now.gears || []) {
      const hubs = pair.map((k) => at(pivot(now, k)));
      for (const c of hubs) piece("circle", { cx: c.x, cy: y(c), r: far(...hubs) / 2, fill: "none", stroke: "#555", "stroke-width": 1.5, "stroke-dasharray": "8 3 2 3" });
    }
    if (now.jack) {
      const [p, q] = now.jack.map(at), middle = { x: (p.x + q.x) / 2, y: (p.y + q.y) / 2 };
      piece("path", { d: `M${p.x} ${y(p)}L${q.x} ${y(q)}`, stroke: "#0a58a8", "stroke-width": 3 });
      piece("path", { d: `M${p.x} ${y(p)}L${middle.x} ${y(middle)}`, stroke: "#0a58a8", "stroke-width": 11 });
    }
    if (now.load) {
      const body = now.bodies[now.load.on], c = body ? { x: (at(body[0]).x + at(body[1]).x) / 2, y: (at(body[0]).y + at(body[1]).y) / 2 } : at(now.load.p);
      const d = body ? "M-16 0A16 16 0 1 1 0 16m0 0l8 -6m-8 6l8 6" : "M0 0H46m0 0l-10 -6m10 6l-10 6";
      piece("path", { d, transform: `translate(${c.x} ${y(c)}) rotate(${body ? 0 : -now.load.a})`, fill: "none", stroke: "#a03000", "stroke-width": 3 });
    }
    for (const [n, c] of Object.entries(now.points)) {
      if (c.g) piece("path", { d: `M${c.x} ${y(c)}l-9 14h18z`, fill: "#ccc", stroke: "#000" });
      piece("circle", { cx: c.x, cy: y(c), r: marks.includes(n) || n === held ? 8 : 5, fill: marks.includes(n) || n === held ? "#0a58a8" : "#fff", stroke: "#000", "stroke-width": 1.5 });
      piece("text", { x: c.x + 8, y: y(c) - 8, "font-size": 16, fill: "#000" }, n);
    }
    for (const [name, all] of [["undo", past], ["redo", ahead]]) place.querySelector(`[data-do=${name}]`).ariaDisabled = !all.length;
    place.querySelectorAll("[data-tool]").forEach((button) => button.setAttribute("aria-pressed", button.dataset.tool === tool));
  }
  const where = (event) => {
    const c = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return { x: c.x, y: HIGH - c.y };
  };
  function tap(c) {
    if (Number.isNaN(c.x + c.y)) return;
    tell(said[tool]);
    acts[tool](c);
    [boxX.value, boxY.value] = [round(c.x), round(c.y)];
  }
  let drag = null;
  svg.addEventListener("pointerdown", (event) => {
    const name = tool === "move" && point(where(event));
    if (!name) return;
    drag = { name, before: copy(now), moved: false };
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const c = where(event), to = { x: round(c.x), y: round(c.y) };
    if (far(to, at(drag.name)) >= STEP) { drag.moved = true; Object.assign(at(drag.name), to); render(); }
  });
  for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => {
    if (drag && drag.moved) { keep(drag.before); held = ""; drag.done = true; }
  });
  svg.addEventListener("click", (event) => { const moved = drag && drag.done; drag = null; if (!moved) tap(where(event)); });
  const does = {
    undo() { step(past, ahead); },
    redo() { step(ahead, past); },
    clear() { change(() => { now = { points: {}, bodies: [], slides: [] }; marks = []; }); },
    put() { tap({ x: parseFloat(boxX.value.replace(",", ".")), y: parseFloat(boxY.value.replace(",", ".")) }); },
  };
  place.addEventListener("click", (event) => {
    const { tool: chosen, do: what } = (event.target.closest("button") || { dataset: {} }).dataset;
    if (what) does[what]();
    if (chosen) { tool = chosen; marks = []; held = ""; tell(said[tool]); render(); }
  });
  place.addEventListener("keydown", (event) => { if (event.key === "Enter" && event.target.matches("input")) { event.preventDefault(); does.put(); } });
  document.addEventListener("keydown", (event) => {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || !"zy".includes(key) || event.target.matches("input, textarea")) return;
    event.preventDefault();
    does[key === "y" || event.shiftKey ? "redo" : "undo"]();
  });
  // What is wrong stands under the drawing as well, where a narrow page shows the rest farther below.
  document.addEventListener("htmx:afterSettle", () => {
    const fault = document.querySelector("#mechanism-now .gap");
    place.querySelector(".wrong").textContent = fault ? fault.textContent : "";
  });
  place.hidden = false;
  read();
  tell(said.ground);
  render();
})();
