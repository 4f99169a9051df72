// A lesson in steps on a narrow screen, and the place where one stopped, which the course page shows. Each step has its address.
// The place is kept on the device, and with the account; of the two the later counts.
(function () {
  "use strict";
  const key = (name) => "lesson " + (document.body.dataset.person || "") + " " + name;
  const place = (name, ofAccount) => {
    let mine = null;
    try { mine = JSON.parse(localStorage.getItem(key(name))); } catch { /* a browser that stores nothing */ }
    const [step, of, at] = ofAccount.split("/").map(Number);
    return at > (mine && mine.at || 0) ? { step: step, of: of, at: at } : mine;
  };
  let unsent = null, timer = 0;
  function send() {
    clearTimeout(timer);
    const headers = JSON.parse(document.body.getAttribute("hx-headers") || "{}");
    if (unsent) fetch(location.pathname, { method: "POST", body: new URLSearchParams({ place: unsent }), headers: headers, keepalive: true }).catch(() => undefined);
    unsent = null;
  }
  const keep = (name, step, of) => {
    const at = Date.now();
    try { localStorage.setItem(key(name), JSON.stringify({ step: step, of: of, at: at })); } catch { /* the account has it */ }
    unsent = [step, of, at].join("/");
    clearTimeout(timer);
    timer = setTimeout(send, 2000);
  };
  addEventListener("pagehide", send);
  const words = (text, ...values) => text.replace(/\{(\d)\}/g, (_, k) => values[k]);

  for (const link of document.querySelectorAll("a[data-place-of]")) {
    const stopped = place(link.dataset.placeOf, link.dataset.place);
    if (!stopped || stopped.step < 2) continue;
    link.hash = "step-" + stopped.step;
    link.nextElementSibling.textContent = words(link.dataset.words, stopped.step, stopped.of);
  }

  const lesson = document.getElementById("lesson");
  if (!lesson) return;
  const file = lesson.dataset.steps, name = lesson.dataset.lesson, stopped = place(name, lesson.dataset.place);
  const narrow = matchMedia("(max-width: 46rem)"), left = history.state;
  const afterLoad = (act) => document.readyState === "complete" ? act() : addEventListener("load", act);

  function begin() {
    const steps = Array.from(lesson.querySelectorAll(".step"));
    const bar = lesson.querySelector(".lesson-bar");

    // The step of an address: its own, or that of the heading or the word it names.
    function named(hash) {
      const target = hash && document.getElementById(decodeURIComponent(hash.slice(1)));
      return target ? steps.indexOf(target.closest(".step")) : -1;
    }

    function show(k, isFirst) {
      steps.forEach((step, j) => step.classList.toggle("shown", j === k));
      lesson.classList.toggle("at-start", k === 0);
      for (const link of bar.querySelectorAll("[data-go]")) {
        const to = k + Number(link.dataset.go);
        link.hash = "step-" + (to + 1);
        const isOut = to < 0 || to >= steps.length;
        link.setAttribute("aria-disabled", String(isOut));
        link.tabIndex = isOut ? -1 : 0;
      }
      bar.querySelector("progress").value = k + 1;
      bar.querySelector("[data-place]").textContent = words(lesson.dataset.stepOf, k + 1, steps.length);
      keep(name, k + 1, steps.length);
      for (const image of steps[k + 1] ? steps[k + 1].querySelectorAll("img[loading]") : []) image.loading = "eager";
      if (isFirst || !narrow.matches) return;
      steps[k].focus({ preventScroll: true });
      scrollTo(0, k === 0 ? 0 : lesson.getBoundingClientRect().top + scrollY - 8);
    }

    addEventListener("hashchange", () => {
      const k = named(location.hash);
      if (k >= 0) show(k, false);
    });
    if (matchMedia("(min-width: 76rem)").matches) lesson.querySelector(".lesson-contents").open = true;
    // What moves by itself can be stopped; where no motion is wanted it stands still by itself.
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    for (const image of isStill ? [] : lesson.querySelectorAll("img[data-still]")) {
      const button = document.createElement("button"), moving = image.src;
      button.type = "button";
      button.className = "stop";
      button.textContent = lesson.dataset.stop;
      button.addEventListener("click", () => {
        const stops = image.src === moving;
        image.src = stops ? image.dataset.still : moving;
        button.textContent = stops ? lesson.dataset.play : lesson.dataset.stop;
      });
      image.after(button);
    }
    for (const failure of ["htmx:sendError", "htmx:responseError"]) {
      lesson.addEventListener(failure, (event) => { event.detail.target.textContent = lesson.dataset.notChecked; });
    }

    // A lesson opens without a network with all its figures: they come when the page is there, unless a browser saves data.
    if (navigator.serviceWorker) afterLoad(() => setTimeout(() => {
      const files = (navigator.connection || {}).saveData ? [] : Array.from(lesson.querySelectorAll("img[loading]"), (image) => [image.src, image.dataset.still || image.src]).flat();
      navigator.serviceWorker.ready.then((one) => one.active.postMessage({ files: Array.from(new Set(file ? [file, ...files] : files)) }));
    }, 1500));

    const asked = named(location.hash);
    const first = asked >= 0 ? asked : narrow.matches && stopped ? Math.min(Math.max(stopped.step, 1), steps.length) - 1 : 0;
    lesson.classList.add("stepped");
    bar.hidden = false;
    if (asked < 0 && first > 0) history.replaceState(null, "", "#step-" + (first + 1));
    const before = stopped;
    show(first, true);
    if (narrow.matches && first > 0) scrollTo(0, lesson.getBoundingClientRect().top + scrollY - 8);
    if (narrow.matches) return;
    // On a wide screen the whole lesson stands there: the place is the step that is read.
    if (before) keep(name, before.step, before.of);
    if (file && asked >= 0) document.getElementById(decodeURIComponent(location.hash.slice(1))).scrollIntoView();
    if (file && left && left.lessonAt) scrollTo(0, left.lessonAt);  // gone back to, or reloaded
    addEventListener("pagehide", () => history.replaceState({ lessonAt: scrollY }, ""));
    const seen = new IntersectionObserver((entries) => {
      const read = entries.filter((entry) => entry.isIntersecting).map((entry) => steps.indexOf(entry.target));
      if (read.length && scrollY > 0 && !narrow.matches) keep(name, Math.max(...read) + 1, steps.length);
    }, { rootMargin: "0px 0px -60% 0px" });
    steps.forEach((step) => seen.observe(step));
  }
  if (!file) { begin(); return; }
  // The page comes with the first step; all of them are a file that the browser keeps.
  lesson.classList.add("opening");
  lesson.classList.toggle("elsewhere", Boolean(location.hash || narrow.matches && stopped && stopped.step > 1));
  fetch(file).then((reply) => reply.ok ? reply.text() : Promise.reject(reply.status)).then((text) => {
    lesson.querySelector(".step").outerHTML = text;
    htmx.process(lesson);
  }).then(begin, () => { lesson.querySelector("[data-missing]").hidden = false; }).finally(() => lesson.classList.remove("opening"));
})();
