// What all pages share. Each page works without it.
(function () {
  "use strict";
  // Times in the reader's zone, which is named where it is another than the server's.
  const times = document.querySelectorAll("time[datetime]");
  for (const time of times) {
    const seconds = "exact" in time.dataset ? { second: "2-digit" } : {};
    const how = { year: "numeric", month: "long", day: "numeric", hour: "2-digit", minute: "2-digit", timeZoneName: "short", ...seconds };
    const at = new Date(time.dateTime);
    if (isNaN(at)) continue;
    time.title = "exact" in time.dataset ? time.textContent : time.textContent + " (" + time.dataset.zone + ")";
    time.textContent = new Intl.DateTimeFormat(document.documentElement.lang === "en" ? "en-GB" : document.documentElement.lang, how).format(at);
  }
  if (times.length) document.querySelectorAll("[data-zone-said]").forEach((one) => { one.hidden = true; });

  // Pages that were seen open without a network, too; a form that meets none stays, and says that nothing was sent.
  let pressed = null;
  function unsent(form) {
    if (form.dataset.keep) { form.dispatchEvent(new CustomEvent("keep:tell", { detail: { text: JSON.parse(form.dataset.keepWords).not_sent } })); return; }
    const said = form.querySelector(".not-sent") || document.createElement("p");
    said.className = "notice not-sent";
    said.setAttribute("role", "alert");
    form.append(said);
    said.textContent = document.body.dataset.notSent;
    said.scrollIntoView({ block: "nearest" });
  }
  document.addEventListener("submit", (event) => {
    const form = event.target;
    if (form.method !== "post" || form.matches("[hx-post]")) return;
    pressed = form;
    if (navigator.onLine || (navigator.serviceWorker && navigator.serviceWorker.controller)) return;
    event.preventDefault();
    unsent(form);
  });
  document.addEventListener("htmx:sendError", ({ target }) => {
    const form = target.closest("form:not([data-keep], .blanks)");  // sheets and lessons tell it themselves
    if (form) unsent(form);
  });
  document.addEventListener("htmx:beforeSwap", () => document.querySelectorAll(".not-sent").forEach((one) => one.remove()));
  const workers = window.isSecureContext && navigator.serviceWorker;
  if (workers && document.body.dataset.person) {
    workers.addEventListener("message", (event) => { if (event.data.offline && pressed) unsent(pressed); });
    const isNew = !workers.controller;
    workers.register("/service-worker.js").then(() => workers.ready).then((one) => {
      const files = performance.getEntriesByType("resource").map((file) => file.name).filter((name) => name.startsWith(location.origin + "/static/"));
      if (isNew) one.active.postMessage({ seen: location.href, files: files });
    }).catch(() => undefined);
  }

  // Without a network the pages are listed that open, the last seen first.
  async function list(place) {
    const found = new Map();
    for (const name of (await caches.keys()).filter((one) => one.startsWith("pages "))) {
      const cache = await caches.open(name);
      for (const { url } of (await cache.keys()).reverse()) {
        const page = new DOMParser().parseFromString(await (await cache.match(url)).text(), "text/html"), title = page.title.split(" – ").slice(0, -1).join(" – ");
        if (title && !found.has(title)) found.set(title, url);
      }
    }
    for (const [title, url] of found) {
      const row = document.createElement("li"), link = document.createElement("a");
      link.href = url; link.textContent = title;
      row.append(link); place.lastElementChild.append(row);
    }
    place.hidden = !found.size;
  }
  const kept = document.querySelector("[data-kept-pages]");
  if (kept && window.caches) list(kept).catch(() => undefined);

  // What is scrolled is reached by keys; while nothing of it is hidden it is no stop of the keyboard.
  const scrolled = new ResizeObserver((all) => {
    for (const { target: one } of all) one.tabIndex = one.scrollWidth > one.clientWidth || one.scrollHeight > one.clientHeight ? 0 : -1;
  });
  const watch = () => document.querySelectorAll(":is(math, pre, .wide-table)[tabindex]").forEach((one) => scrolled.observe(one));
  for (const comes of ["htmx:afterSettle", "lesson:came"]) document.addEventListener(comes, watch);
  watch();

  // Without a script a section stands in the whole lesson alone; with one the steps come as a file that the browser keeps.
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[href*='?whole#']");
    if (link) link.search = "";
  });

  // A page that answers a form is not sent again when it is gone back to.
  const address = document.body.querySelector("[data-address]");
  if (address) history.replaceState(null, "", address.dataset.address);
})();
