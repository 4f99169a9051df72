// Explore: a slider beside each number, and a handle on the crank. What one says goes to the others; the form brings the rest
// by itself.
(function () {
  "use strict";
  const form = document.getElementById("explore"), driver = form && [...form.querySelectorAll("[data-of]")].shift();
  if (!form) return;
  const boxOf = (slider) => document.getElementById(slider.dataset.of);
  const show = (slider) => { boxOf(slider).value = document.documentElement.lang === "fr" ? slider.value.replace(".", ",") : slider.value; };
  let typing = 0;
  form.querySelectorAll("input[type=range]").forEach((slider) => {
    slider.hidden = false;
    slider.addEventListener("input", () => show(slider));
    boxOf(slider).addEventListener("input", (event) => {
      const number = Number(event.target.value.replace(",", ".").replace("−", "-"));
      if (event.target.value.trim() && !isNaN(number)) slider.value = number;
      event.stopPropagation();  // the beginning of a number is none
      clearTimeout(typing);
      typing = setTimeout(() => form.dispatchEvent(new Event("turned")), 500);
    });
  });

  // The figure is another one after each change: what is held is remembered here.
  const near = 24;
  let held = null, sent = 0;
  const figure = () => form.querySelector(".explored svg[data-crank]");
  function places() {
    const svg = figure(), [x, y, u, v] = (svg ? svg.dataset.crank : "").split(" ").map(Number);
    return v === undefined ? null : [[x, y], [u, v]].map((at) => new DOMPoint(...at).matrixTransform(svg.getScreenCTM()));
  }
  const heading = (pivot, x, y) => Math.atan2(pivot.y - y, x - pivot.x) * 180 / Math.PI;
  function handle() {
    const ends = places(), svg = figure();
    if (!ends || svg.querySelector(".handle")) return;
    const unit = svg.getScreenCTM().a, at = svg.dataset.crank.split(" ");
    for (const [name, r] of [["grip", 9], ["handle", near]]) {
      const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
      const how = { class: name, cx: at[2], cy: at[3], r: r / unit };
      Object.entries(how).forEach(([key, is]) => ring.setAttribute(key, is));
      svg.append(ring);
    }
  }
  form.addEventListener("touchstart", (event) => { if (event.target.matches(".handle")) event.preventDefault(); }, { passive: false });
  form.addEventListener("pointerdown", (event) => {
    if (!event.target.matches(".handle")) return;
    held = heading(places()[0], event.clientX, event.clientY);
    form.setPointerCapture(event.pointerId);
  });
  form.addEventListener("pointermove", (event) => {
    const ends = held !== null && places();
    if (!ends) return;
    const now = heading(ends[0], event.clientX, event.clientY), by = now - held;
    held = now;
    driver.value = ((+driver.value + by - 360 * Math.round(by / 360)) % 360 + 360) % 360;
    show(driver);
    follow(now);
    if (event.timeStamp - sent < 200) return; // a person may ask 400 times a minute
    sent = event.timeStamp;
    form.dispatchEvent(new Event("turned"));
  });
  // The handle follows the finger at once, the figure as soon as it comes.
  function follow(angle) {
    const svg = figure(), [x, y, u, v] = svg.dataset.crank.split(" ").map(Number), arm = Math.hypot(u - x, v - y);
    svg.querySelectorAll(".grip, .handle").forEach((ring) => {
      ring.setAttribute("cx", x + arm * Math.cos(angle * Math.PI / 180));
      ring.setAttribute("cy", y - arm * Math.sin(angle * Math.PI / 180));
    });
  }
  for (const end of ["pointerup", "pointercancel"]) {
    form.addEventListener(end, () => {
      if (held !== null) driver.dispatchEvent(new Event("change", { bubbles: true }));
      held = null;
    });
  }
  document.addEventListener("htmx:afterSettle", handle);
  handle();
})();
