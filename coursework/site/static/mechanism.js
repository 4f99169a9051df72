// The page of a mechanism: its figure turns; below, the drawing that writes its text.
(function () {
  "use strict";
  const form = document.getElementById("mechanism");
  if (!form) return;
  let at = 0, data = null, parts = [], svg = null, slider = null, timer = 0;

  function begin() {
    const said = form.querySelector(".moving-data");
    clearInterval(timer);
    form.querySelectorAll("[data-apply]").forEach((button) => { button.hidden = true; });
    if (!said) { data = null; return; }
    data = JSON.parse(said.textContent);
    svg = form.querySelector(".moving svg");
    parts = [...svg.querySelectorAll("[data-moves]")];
    slider = form.querySelector(".turn input");
    form.querySelector(".turn").hidden = false;
    if (data.way.length && !svg.querySelector(".handle")) {
      const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
      ring.setAttribute("class", "handle");
      ring.setAttribute("r", 4);
      svg.append(ring);
    }
    show(+slider.value);
  }
  function show(k) {
    at = k;
    slider.value = k;
    parts.forEach((part, n) => part.setAttribute(part.dataset.moves, data.frames[k][n]));
    const ring = svg.querySelector(".handle");
    if (ring) { ring.setAttribute("cx", data.way[k][0]); ring.setAttribute("cy", data.way[k][1]); }
  }
  function drag(event) {
    const c = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse()), [x, y] = data.pivot;
    const way = Math.atan2(c.y - y, c.x - x), off = (k) => Math.abs(Math.sin((Math.atan2(data.way[k][1] - y, data.way[k][0] - x) - way) / 2));
    show(data.frames.reduce((best, _, k) => (off(k) < off(best) ? k : best), at));
  }
  form.addEventListener("pointerdown", (event) => {
    if (!data || !data.way.length || !svg.contains(event.target)) return;
    svg.setPointerCapture(event.pointerId);
    drag(event);
  });
  form.addEventListener("pointermove", (event) => {
    if (data && svg.contains(event.target) && svg.hasPointerCapture(event.pointerId)) drag(event);
  });
  form.addEventListener("input", (event) => { if (event.target === slider) show(+slider.value); });
  form.addEventListener("click", (event) => {
    if (!event.target.closest("[data-turn]")) return;
    if (timer) { clearInterval(timer); timer = 0; return; }
    timer = setInterval(() => show((at + 1) % data.frames.length), 60);
  });
  // The exercise is named after its title, in letters that a name has, until somebody names it.
  const name = form.querySelector("[name=name]");
  const plain = (text) => text.normalize("NFD").replace(/[\u0300-\u036f]/g, "").toLowerCase().replace(/[^a-z0-9]+/g, "_").replace(/^[_0-9]+|_+$/g, "").slice(0, 60);
  function follow() {
    const title = form.elements[name.dataset.from];
    if (title) name.value = plain(title.value);
  }
  form.addEventListener("input", (event) => {
    if (event.target === name) delete name.dataset.from;
    else follow();
  });
  form.addEventListener("change", (event) => { if (event.target === name) name.value = plain(name.value); });
  document.addEventListener("htmx:afterSettle", () => { begin(); follow(); });
  begin();
  follow();
})();
