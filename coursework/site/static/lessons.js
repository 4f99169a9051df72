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
  const files = (lesson.dataset.steps || "").split(" ").filter(Boolean), name = lesson.dataset.lesson, stopped = place(name, lesson.dataset.place);
  const narrow = matchMedia("(max-width: 46rem)"), left = history.state;
  const afterLoad = (act) => document.readyState === "complete" ? act() : addEventListener("load", act);

  // What moves by itself can be stopped; where no motion is wanted it stands still by itself.
  const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
  function equip(place) {
    for (const image of isStill ? [] : place.querySelectorAll("img[data-still]")) {
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
  }

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
    // The page that opens without a network holds what is checked from now on.
    lesson.addEventListener("htmx:afterSwap", () => navigator.serviceWorker && navigator.serviceWorker.ready.then((one) => one.active.postMessage({ seen: location.href })));
    for (const failure of ["htmx:sendError", "htmx:responseError"]) {
      lesson.addEventListener(failure, (event) => { event.detail.target.textContent = lesson.dataset.notChecked; });
    }

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
    if (files.length && asked >= 0) document.getElementById(decodeURIComponent(location.hash.slice(1))).scrollIntoView();
    if (files.length && left && left.lessonAt) scrollTo(0, left.lessonAt);  // gone back to, or reloaded
    addEventListener("pagehide", () => history.replaceState({ lessonAt: scrollY }, ""));
    const seen = new IntersectionObserver((entries) => {
      const read = entries.filter((entry) => entry.isIntersecting).map((entry) => steps.indexOf(entry.target));
      if (read.length && scrollY > 0 && !narrow.matches) keep(name, Math.max(...read) + 1, steps.length);
    }, { rootMargin: "0px 0px -60% 0px" });
    steps.forEach((step) => seen.observe(step));
  }
  // A lesson opens without a network, and prints, with all its figures: they come when the page is there, unless a browser saves data.
  const keepFigures = () => afterLoad(() => setTimeout(() => {
    const images = (navigator.connection || {}).saveData ? [] : Array.from(lesson.querySelectorAll("img[loading]")), stills = images.map((image) => image.dataset.still || image.src);
    const kept = Array.from(new Set([...files, ...images.map((image) => image.src), ...stills]));
    if (navigator.serviceWorker) navigator.serviceWorker.ready.then((one) => one.active.postMessage({ files: kept }));
    for (const image of images) image.loading = "eager";
  }, 1500));
  if (!files.length) { equip(lesson); begin(); keepFigures(); return; }
  // The page comes with the first step; all of them are files that the browser keeps. On a narrow screen one begins to read when
  // the first of them is there, if one begins there: of the others stands an empty place until they are.
  lesson.classList.add("opening");
  lesson.classList.toggle("elsewhere", Boolean(location.hash || narrow.matches && stopped && stopped.step > 1));
  const missing = () => { lesson.querySelector("[data-missing]").hidden = false; };
  const parts = files.map((file) => fetch(file).then((reply) => reply.ok ? reply.text() : Promise.reject(reply.status)));
  parts.forEach((part) => part.catch(() => undefined));  // told once, below
  function put(html) {
    const part = document.createElement("template");
    part.innerHTML = html;
    for (const step of Array.from(part.content.children)) {
      const place = document.getElementById(step.id);
      place.replaceChildren(...step.childNodes);
      htmx.process(place);
      equip(place);
    }
    // An example that was checked before stands as it was left.
    for (const before of lesson.querySelectorAll("template[data-checked]")) {
      const form = before.content.firstElementChild, place = document.getElementById(form.id);
      if (!place) continue;
      place.replaceWith(form);
      before.remove();
      htmx.process(form);
    }
    document.dispatchEvent(new Event("lesson:came"));
  }
  async function open() {
    const end = lesson.querySelector("[data-missing]");
    for (let k = 2; k <= Number(lesson.dataset.count); k += 1) {
      const place = document.createElement("div");
      place.className = "step"; place.id = "step-" + k; place.tabIndex = -1;
      end.before(place);
    }
    put(await parts[0]);
    const wanted = location.hash || "#step-" + (stopped ? stopped.step : 1), there = document.getElementById(decodeURIComponent(wanted.slice(1)));
    const isHere = narrow.matches && there && there.childElementCount > 0;
    if (isHere) { begin(); lesson.classList.remove("opening"); }
    (await Promise.all(parts.slice(1))).forEach(put);
    if (!isHere) begin();
    keepFigures();
  }
  open().catch(missing).finally(() => lesson.classList.remove("opening"));
})();
