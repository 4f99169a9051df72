// Remaining time of a paper: counts down in an element with data-remaining (seconds), by the time that this page has been open;
// the reader's clock is not asked. Without a script the element states when the time ends. What is typed is sent just before.
(function () {
  "use strict";
  const place = document.querySelector("[data-remaining]");
  if (!place || !navigator.onLine) return;
  const said = JSON.parse(place.dataset.remainingWords), count = place.querySelector("[data-count]"), told = place.querySelector("[role=status]");
  const whole = Number(place.dataset.remaining), begun = performance.now(), marks = [900, 300, 60].filter((mark) => mark < whole);
  const two = (number) => String(number).padStart(2, "0");
  const clock = (left) => (left >= 3600 ? Math.floor(left / 3600) + ":" + two(Math.floor(left / 60) % 60) : Math.floor(left / 60)) + ":" + two(left % 60);
  let sent = false;
  function tick() {
    const left = Math.max(0, Math.ceil(whole - (performance.now() - begun) / 1000));
    count.textContent = clock(left);
    place.classList.toggle("soon", left <= 300);
    while (marks.length && left <= marks[0]) told.textContent = said.left.replace("{0}", Math.round(marks.shift() / 60));
    if (left <= 3 && !sent) { sent = true; document.dispatchEvent(new Event("visibilitychange")); }
    if (left) return;
    clearInterval(timer);
    told.textContent = said.over;
    document.querySelectorAll("form[data-keep] button").forEach((button) => { button.disabled = true; });
    setTimeout(() => location.reload(), 25000);
  }
  const timer = setInterval(tick, 500);
  tick();
})();
