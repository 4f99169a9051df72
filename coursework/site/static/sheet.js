// Reading a sheet: figure and data come again by a bar while one answers below them, and one question at a time where it is wished.
(function () {
  "use strict";
  const parts = document.getElementById("sheet-reading");
  if (!parts) return;
  const made = (name) => parts.content.querySelector("[" + name + "]").cloneNode(true);

  // ---------------------------------------------------------------- figure and data
  const bar = made("data-bar"), button = bar.querySelector("button");
  const wide = matchMedia("(min-width: 68.75rem)");
  const room = document.createElement("div");  // where the data stood, so that the page does not move
  let current = null;  // the data of the exercise that is being read
  function close() {
    if (current) current.classList.remove("pinned");
    room.remove();
    button.setAttribute("aria-expanded", "false");
  }
  function open() {
    room.style.height = current.offsetHeight + "px";
    current.before(room);
    current.classList.add("pinned");
    button.setAttribute("aria-expanded", "true");
  }
  // Data are past where their end is above the screen, and their exercise is not.
  function look() {
    const past = (data) => data.getBoundingClientRect().bottom < 0 && data.parentElement.getBoundingClientRect().bottom > 100;
    if (button.getAttribute("aria-expanded") === "true") return;
    current = wide.matches ? null : Array.from(document.querySelectorAll(".sheet-data")).find((data) => data.offsetHeight && past(data)) || null;
    bar.hidden = !current;
  }
  button.addEventListener("click", () => {
    if (button.getAttribute("aria-expanded") === "true") { close(); look(); } else open();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && button.getAttribute("aria-expanded") === "true") { close(); button.focus(); }
  });
  document.querySelector("main").prepend(bar);
  let waits = false;
  addEventListener("scroll", () => {
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => { waits = false; look(); });
  }, { passive: true });
  wide.addEventListener("change", () => { close(); look(); });
  look();

  // --------------------------------------------------------- one question at a time
  const KEY = "coursework one question";
  const questions = Array.from(document.querySelectorAll("ol.questions > li"));
  if (questions.length < 2) return;
  const choice = made("data-one-switch"), steps = made("data-one-steps");
  const place = steps.querySelector("[data-place]");
  let now = 0;
  const isOne = () => document.body.classList.contains("one-question");
  const stored = () => { try { return localStorage.getItem(KEY) === "1"; } catch (fault) { return false; } };
  function show(index, moves) {
    now = Math.max(0, Math.min(questions.length - 1, index));
    questions.forEach((question, one) => question.classList.toggle("now", one === now));
    place.textContent = (now + 1) + " / " + questions.length;
    for (const step of steps.querySelectorAll("[data-step]")) step.disabled = !questions[now + Number(step.dataset.step)];
    const list = questions[now].closest("ol");
    if (steps.previousElementSibling !== list) list.after(steps);
    if (!moves) return;
    questions[now].scrollIntoView({ block: "nearest" });
    const box = questions[now].querySelector("input:not([type=hidden]), textarea");
    if (box) box.focus({ preventScroll: true });
  }
  function turn(on) {
    document.body.classList.toggle("one-question", on);
    choice.firstElementChild.setAttribute("aria-pressed", String(on));
    steps.hidden = !on;
    if (on) show(now, false);
  }
  function reveal(target) {
    const question = target && target.closest("ol.questions > li");
    if (isOne() && question) show(questions.indexOf(question), false);
  }
  choice.firstElementChild.addEventListener("click", () => {
    turn(!isOne());
    try { localStorage.setItem(KEY, isOne() ? "1" : ""); } catch (fault) { /* it holds for this page */ }
  });
  steps.addEventListener("click", (event) => {
    const step = event.target.closest("[data-step]");
    if (step) show(now + Number(step.dataset.step), true);
  });
  // What a link or the page itself leads to is shown.
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[href^='#']");
    if (link) reveal(document.getElementById(link.getAttribute("href").slice(1)));
  });
  document.addEventListener("focusin", (event) => reveal(event.target));
  questions[0].closest("ol").before(choice);
  turn(stored());
  if (location.hash) reveal(document.getElementById(decodeURIComponent(location.hash.slice(1))));
})();
