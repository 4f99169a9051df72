(function () {
  "use strict";
  const stated = document.getElementById("motion-data");
  if (!stated) return; // questions come first that the motion answers
  const data = JSON.parse(stated.textContent);
  const all = (selector) => Array.from(document.querySelectorAll(selector));
  const slider = document.getElementById("angle"), play = document.getElementById("play");
  const things = all("[data-track]").map((node) => [node, data.tracks[+node.dataset.track]]);
  const svg = document.querySelector(".motion svg"), crank = data.crank;
  let running = false, place = 0, before = 0;

  // --------------------------------------------------------------- the figure
  // What moves stands palely where it began.
  const ghost = piece("g", "ghost");
  things.forEach(([node]) => {
    if (node.dataset.effect !== undefined || node.dataset.label !== undefined) return;
    const pale = node.cloneNode(true);
    delete pale.dataset.track;
    ghost.append(pale);
  });
  svg.querySelector("g").prepend(ghost);

  function piece(name, of) {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    node.setAttribute("class", of);
    return node;
  }
  function draw(a, b, share) {
    ghost.style.display = a === data.first && !share ? "none" : "";
    grip(a, b, share);
    for (const [node, track] of things) {
      const one = track.rows[a], two = track.rows[b];
      const at = (i) => (one[i] + share * (two[i] - one[i])).toFixed(2);
      if (track.mark) { node.setAttribute("transform", "translate(" + at(0) + " " + at(1) + ")"); continue; }
      let way = "";
      for (let i = 0; i < one.length; i += 2) way += (i ? "L" : "M") + at(i) + " " + at(i + 1);
      node.setAttribute("d", way + (track.closed ? "Z" : ""));
    }
  }
  // ---------------------------------------------------------------- the handle
  const turn = crank && unwrapped(crank.rows.map((p) => heading(p[0], p[1])));
  const hold = crank && [piece("circle", "grip"), piece("circle", "handle")];
  let turned = 0;

  function heading(x, y) { return Math.atan2(crank.pivot[1] - y, x - crank.pivot[0]) * 180 / Math.PI; }
  function nearest(angle, to) { return angle + 360 * Math.round((to - angle) / 360); }
  function unwrapped(angles) { return angles.reduce((row, a) => [...row, nearest(a, row.length ? row[row.length - 1] : a)], []); }
  function grip(a, b, share) {
    if (!crank) return;
    const one = crank.rows[a], two = crank.rows[b];
    for (const node of hold) {
      node.setAttribute("cx", one[0] + share * (two[0] - one[0]));
      node.setAttribute("cy", one[1] + share * (two[1] - one[1]));
    }
  }
  // A finger takes hold of 44 pixels, whatever the size of the drawing.
  function size() {
    const unit = svg.getScreenCTM();
    if (!unit || !unit.a) return;
    [9, 24].forEach((r, i) => hold[i].setAttribute("r", r / unit.a));
  }
  function follow(event) {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const low = turn[0], high = turn[turn.length - 1];
    turned = nearest(heading(at.x, at.y), turned);
    if (data.closed) turned = low + ((turned - low) % 360 + 360) % 360;
    else turned = Math.min(high, Math.max(low, turned));
    let i = 0;
    while (i < turn.length - 1 && turn[i + 1] <= turned) i += 1;
    const last = i === turn.length - 1, next = last ? (data.closed ? 0 : i) : i + 1;
    const span = (last ? low + 360 : turn[next]) - turn[i];
    const share = next === i ? 0 : (turned - turn[i]) / span;
    draw(i, next, share);
    tell(share < 0.5 ? i : next);
  }
  function holdable() {
    const handle = hold[1];
    hold[0].setAttribute("stroke-width", 0.4);
    svg.append(...hold);
    all(".by-handle").forEach((node) => { node.hidden = false; });
    size();
    addEventListener("resize", size);
    const of = svg.classList;
    handle.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
    handle.addEventListener("pointerdown", (event) => {
      if (running) run(false);
      handle.setPointerCapture(event.pointerId);
      of.add("dragged");
      turned = turn[+slider.value];
    });
    handle.addEventListener("pointermove", (event) => { if (of.contains("dragged")) follow(event); });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => of.remove("dragged"));
  }

  // --------------------------------------------------------- slider, play, choices
  function tell(instant) {
    slider.value = instant;
    slider.setAttribute("aria-valuetext", data.angles[instant]);
    for (const id of ["angle-shown", "angle-told"]) {
      const node = document.getElementById(id);
      if (node) node.textContent = data.angles[instant];
    }
    all("[data-reading]").forEach((node) => {
      node.textContent = data.readings[+node.dataset.reading][instant] || "–";
    });
  }
  function show(instant) { draw(instant, instant, 0); tell(instant); }
  function step(now) {
    if (!running) return;
    place = (place + (now - before) / 1000 / data.seconds) % 1;
    before = now;
    let i = 0;
    while (i < data.times.length - 2 && data.times[i + 1] <= place) i += 1;
    const share = Math.min(1, (place - data.times[i]) / (data.times[i + 1] - data.times[i]));
    draw(data.order[i], data.order[i + 1], share);
    tell(data.order[share < 0.5 ? i : i + 1]);
    requestAnimationFrame(step);
  }
  function run(on) {
    running = on;
    play.textContent = on ? play.dataset.pause : play.dataset.play;
    if (!on) { show(+slider.value); return; }
    place = data.times[Math.max(0, data.order.indexOf(+slider.value))] % 1;
    before = performance.now();
    requestAnimationFrame(step);
  }
  function choose() {
    const on = (name) => new Set(all("input[name=" + name + "]:checked").map((box) => box.value));
    const effects = on("effect"), points = on("point");
    all("[data-effect]").forEach((node) => {
      const seen = effects.has(node.dataset.effect) && (!node.dataset.point || points.has(node.dataset.point));
      node.style.display = seen ? "" : "none";
    });
    all("[data-key]").forEach((node) => { node.style.opacity = effects.has(node.dataset.key) ? "" : ".3"; });
    all("[data-effects]").forEach((row) => {
      const called = row.dataset.effects.split(" ").some((effect) => effects.has(effect));
      row.hidden = !called || (row.dataset.of !== undefined && !points.has(row.dataset.of));
    });
    all(".readings").forEach((section) => { section.hidden = !section.querySelector("tbody tr:not([hidden])"); });
  }
  slider.addEventListener("input", () => { const instant = +slider.value; run(false); show(instant); });
  play.addEventListener("click", () => run(!running));
  document.getElementById("back").addEventListener("click", () => { run(false); show(data.first); });
  all(".controls input[type=checkbox]").forEach((box) => box.addEventListener("change", choose));
  document.querySelector(".controls").hidden = false;
  if (crank) holdable();
  // An address that ends in #135 opens at the nearest angle to 135 degrees.
  const asked = /^#(-?\d+)$/.exec(location.hash);
  const away = (angle) => Math.abs(data.film ? angle - +asked[1] : ((angle - +asked[1] + 180) % 360 + 360) % 360 - 180);
  show(asked ? data.degrees.reduce((best, a, i) => (away(a) < away(data.degrees[best]) ? i : best), 0) : data.first);
  choose();
})();
