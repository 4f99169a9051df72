// Draws a linkage, and writes it as the text of its file: points, bars and plates, slides, the driver. Millimetres, y upwards; lengths
// are rounded to 5 mm and angles to 5°. What is drawn stays in the text's first line, which a page that is opened again reads.
(function () {
  "use strict";
  const place = document.querySelector(".draw");
  if (!place) return;
  const MARK = "# drawing: ", HIGH = 320, LETTERS = "ABCDEFGHKLMNPQRSTUVWXYZ", STEP = 5;
  const said = JSON.parse(place.dataset.said), svg = place.querySelector("svg"), told = place.querySelector(".told");
  const area = () => document.getElementById("mechanism-text"), [boxX, boxY] = place.querySelectorAll("input");
  let now = { points: {}, bodies: [], slides: [] }, past = [], tool = "ground", marks = [], held = "";

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
  function bodyAt(c) {
    const near = now.bodies.map((body, k) => [away(body, c), k]).filter(([d]) => d < 14 * unit()).sort((a, b) => a[0] - b[0]);
    return near.length ? near[0][1] : -1;
  }

  // --- changing
  function change(act) {
    const before = copy(now);
    act();
    past.push(before);
    write(before);
    render();
  }
  function create(c, g) {
    const grounded = !Object.keys(now.points).some((n) => n === "O");
    const name = g && grounded ? "O" : [...LETTERS].find((n) => !(n in now.points));
    if (!name) { tell(said.full); return ""; }
    now.points[name] = { x: round(c.x), y: round(c.y), ...(g ? { g: 1 } : {}) };
    return name;
  }
  function remove(c) {
    const name = point(c), body = bodyAt(c);
    if (name) {
      delete now.points[name];
      now.bodies = now.bodies.map((one) => one.filter((n) => n !== name));
      now.slides = now.slides.filter((one) => one.p !== name);
    } else if (body >= 0) now.bodies[body] = [];
    const gone = (k) => !now.bodies[k] || now.bodies[k].length < 2;
    now.slides = now.slides.filter((one) => one.on === undefined || !gone(one.on));
    const kept = now.bodies.map((_, k) => k).filter((k) => !gone(k));
    now.slides.forEach((one) => { if (one.on !== undefined) one.on = kept.indexOf(one.on); });
    now.driver = kept.indexOf(now.driver);
    now.bodies = kept.map((k) => now.bodies[k]);
  }
  function join() {
    const body = [...new Set(marks)];
    marks = [];
    now.bodies.push(body);
    if (!(now.driver >= 0) && body.length === 2 && body.some((n) => at(n).g)) now.driver = now.bodies.length - 1;
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
        const name = point(c) || create(c);
        if (name && !marks.includes(name)) marks.push(name);
        if (marks.length === 2) join();
      });
    },
    plate(c) {
      change(() => {
        const name = point(c) || create(c);
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
        if (on >= 0 && !now.bodies[on].includes(name) && !near) now.slides.push({ p: name, on });
        else now.slides.push({ p: name, a: half(heading(at(name), c)) });
      });
    },
    driver(c) {
      const k = bodyAt(c);
      if (k < 0 || !now.bodies[k].some((n) => at(n).g)) tell(said.no_driver);
      else change(() => { now.driver = k; });
    },
    move(c) {
      const near = point(c), name = held;
      if (name && (!near || near === name) && far(at(name), c) > STEP) change(() => { held = ""; Object.assign(at(name), { x: round(c.x), y: round(c.y) }); });
      else { held = near; render(); }
    },
    delete(c) { change(() => remove(c)); },
  };

  // --- text
  function compose(state) {
    const given = new Map(), ground = [], bodies = [], slides = [], sides = [], turns = [], P = state.points;
    const put = (name, value, u = "mm") => { given.set(name, `${name} = "${value} ${u}"`); return name; };
    const order = state.bodies.map((_, k) => k).sort((a, b) => (b === state.driver) - (a === state.driver) || a - b);
    const drive = state.bodies[state.driver] || [], pivot = drive.find((n) => P[n].g), origin = P[pivot] || { x: 0, y: 0 };
    const number = (k) => order.indexOf(k) + 2, first = (body) => body.find((n) => P[n].g) || body[0];
    for (const [n, c] of Object.entries(P)) {
      if (!c.g) continue;
      const place = [["x", c.x - origin.x], ["y", c.y - origin.y]].map(([axis, v]) => `"${v ? put(axis + n, v) : "0 mm"}"`);
      ground.push(`${n} = [${place.join(", ")}]`);
    }
    for (const k of order) {
      const body = state.bodies[k], start = k === state.driver ? pivot : first(body), [next, ...rest] = body.filter((n) => n !== start);
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
    // A pair of bodies from points that stand already: of two ways to close it, the drawn one.
    const placed = new Set([...Object.keys(P).filter((n) => P[n].g), ...drive]), left = new Set(order.filter((k) => k !== state.driver));
    const settle = (...all) => all.forEach((k) => { left.delete(k); state.bodies[k].forEach((n) => placed.add(n)); });
    for (let tries = left.size + 1; tries; tries -= 1) {
      for (const k of left) {
        const body = state.bodies[k], start = body.find((n) => placed.has(n));
        if (!start) continue;
        const rail = state.slides.find((one) => one.on === undefined && body.includes(one.p) && !placed.has(one.p));
        const guide = state.slides.find((one) => one.on === k && placed.has(one.p));
        if (rail) {
          const a = (heading(P[start], P[rail.p]) - rail.a) * Math.PI / 180;
          sides.push(`${rail.p} = "${Math.cos(a) < 0 ? "behind" : "ahead of"} ${start}"`);
          settle(k);
        } else if (guide) settle(k);
        else {
          const mate = [...left].find((m) => m !== k && state.bodies[m].some((n) => placed.has(n)) && state.bodies[m].some((n) => body.includes(n) && !placed.has(n)));
          if (mate === undefined) continue;
          const inner = state.bodies[mate].find((n) => body.includes(n) && !placed.has(n)), end = state.bodies[mate].find((n) => placed.has(n));
          const [p, q, b] = [P[start], P[end], P[inner]], cross = (q.x - p.x) * (b.y - p.y) - (q.y - p.y) * (b.x - p.x);
          sides.push(`${inner} = "${cross < 0 ? "right" : "left"} of ${start} -> ${end}"`);
          settle(k, mate);
        }
      }
    }
    given.set("theta2", 'theta2 = { from = "-175 deg", to = "180 deg", step = "5 deg" }');
    given.set("omega2", 'omega2 = "10 rad/s"');
    const asked = [...turns, ...state.slides.map((one) => `s_${one.p}`)], list = (all) => all.map((n) => `"${n}"`).join(", ");
    const rates = asked.map((n) => (n.startsWith("theta") ? n.replace("theta", "omega") : `${n}_dot`));
    const ask = asked.length ? `positions = [${list(asked)}]\nvelocities = [${list(rates)}]` : "mobility = true";
    const tables = [["ground", ground], ["bodies", bodies], ["slides", slides], ["assembly", sides]].filter(([, all]) => all.length);
    return { given, ask: `[ask]\n${ask}\n`, tables: tables.map(([name, all]) => `[${name}]\n${all.join("\n")}\n`).join("\n"), shape: asked.join() + Object.keys(P) };
  }
  // What the boxes, or a hand, have changed stays where the drawing has not.
  function write(before) {
    if (!now.bodies.length) return;
    const text = area().value, was = compose(before), is = compose(now), line = (name) => (text.match(new RegExp(`^${name} *=.*$`, "m")) || [""])[0];
    const given = [...is.given].map(([name, says]) => (was.given.get(name) === says && line(name)) || says);
    const same = was.shape === is.shape, ask = (same && (text.match(/^\[ask\][^]*$/m) || [""])[0]) || is.ask;
    if (same && line("require")) given.push(line("require"));
    area().value = `${MARK}${JSON.stringify(now)}\n${line("title") || said.untitled}\n\n[given]\n${given.join("\n")}\n\n${is.tables}\n${ask}`;
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
      piece("rect", { x: -12, y: -7, width: 24, height: 14, fill: "#fff", stroke: "#000", "stroke-width": 1.5, transform: `translate(${c.x} ${y(c)}) rotate(${-turn})` });
    }
    now.bodies.forEach((body, k) => piece("polygon", {
      points: body.map((n) => `${at(n).x},${y(at(n))}`).join(" "), stroke: k === now.driver ? "#0a58a8" : "#000", "stroke-width": k === now.driver ? 5 : 3.5,
      "stroke-linejoin": "round", fill: "#0002" }));
    for (const [n, c] of Object.entries(now.points)) {
      if (c.g) piece("path", { d: `M${c.x} ${y(c)}l-9 14h18z`, fill: "#ccc", stroke: "#000" });
      piece("circle", { cx: c.x, cy: y(c), r: marks.includes(n) || n === held ? 8 : 5, fill: marks.includes(n) || n === held ? "#0a58a8" : "#fff", stroke: "#000", "stroke-width": 1.5 });
      piece("text", { x: c.x + 8, y: y(c) - 8, "font-size": 16, fill: "#000" }, n);
    }
    place.querySelectorAll("[data-tool]").forEach((button) => button.setAttribute("aria-pressed", button.dataset.tool === tool));
  }
  const where = (event) => {
    const c = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return { x: c.x, y: HIGH - c.y };
  };
  function tap(c) {
    if (Number.isNaN(c.x + c.y)) return;
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
    if (drag && drag.moved) { past.push(drag.before); write(drag.before); held = ""; drag.done = true; }
  });
  svg.addEventListener("click", (event) => { const moved = drag && drag.done; drag = null; if (!moved) tap(where(event)); });
  const does = {
    undo() { if (!past.length) return; const before = now; now = past.pop(); marks = []; held = ""; write(before); render(); },
    clear() { change(() => { now = { points: {}, bodies: [], slides: [] }; marks = []; }); },
    put() { tap({ x: parseFloat(boxX.value.replace(",", ".")), y: parseFloat(boxY.value.replace(",", ".")) }); },
  };
  place.addEventListener("click", (event) => {
    const { tool: chosen, do: what } = (event.target.closest("button") || { dataset: {} }).dataset;
    if (what) does[what]();
    if (chosen) { tool = chosen; marks = []; held = ""; tell(said[tool]); render(); }
  });
  place.addEventListener("keydown", (event) => { if (event.key === "Enter" && event.target.matches("input")) { event.preventDefault(); does.put(); } });
  place.hidden = false;
  read();
  tell(said.ground);
  render();
})();
