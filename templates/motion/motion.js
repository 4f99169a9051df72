(function () {
  "use strict";
  const data = JSON.parse(document.getElementById("motion-data").textContent);
  const all = (selector) => Array.from(document.querySelectorAll(selector));
  const slider = document.getElementById("angle"), play = document.getElementById("play");
  const things = all("[data-track]").map((node) => [node, data.tracks[+node.dataset.track]]);
  let running = false, place = 0, before = 0;

  function draw(a, b, share) {
    for (const [node, track] of things) {
      const one = track.rows[a], two = track.rows[b];
      const at = (i) => (one[i] + share * (two[i] - one[i])).toFixed(2);
      if (track.mark) { node.setAttribute("transform", "translate(" + at(0) + " " + at(1) + ")"); continue; }
      let way = "";
      for (let i = 0; i < one.length; i += 2) way += (i ? "L" : "M") + at(i) + " " + at(i + 1);
      node.setAttribute("d", way + (track.closed ? "Z" : ""));
    }
  }
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
  // An address that ends in #135 opens at the nearest angle to 135 degrees.
  const asked = /^#(-?\d+)$/.exec(location.hash);
  const away = (angle) => Math.abs(data.film ? angle - +asked[1] : ((angle - +asked[1] + 180) % 360 + 360) % 360 - 180);
  show(asked ? data.degrees.reduce((best, a, i) => (away(a) < away(data.degrees[best]) ? i : best), 0) : data.first);
  choose();
})();
