// Asks whether there is something new, and takes over what differs; the sheet keeps its place on the screen.
(function () {
  "use strict";
  const every = 250;
  const pieces = ["head", "views", "told", "shown"];

  function keepPlace(before, after) {
    const from = before && before.contentWindow;
    if (!from || !after) return;
    let place = 0;
    try { place = from.scrollY; } catch (fault) { return; }
    after.addEventListener("load", () => { try { after.contentWindow.scrollTo(0, place); } catch (fault) { return; } });
  }

  async function take() {
    const answer = await fetch(location.href);
    if (!answer.ok) return;
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    for (const name of pieces) {
      const here = document.getElementById(name), there = page.getElementById(name);
      if (!here || !there || here.outerHTML === there.outerHTML) continue;
      if (name === "head" && here.contains(document.activeElement)) continue;
      keepPlace(here.querySelector("iframe"), there.querySelector("iframe"));
      here.replaceWith(document.adoptNode(there));
    }
    document.documentElement.dataset.stamp = page.documentElement.dataset.stamp;
  }

  async function look() {
    try {
      const answer = await fetch("/state");
      const told = await answer.json();
      if (told.stamp !== document.documentElement.dataset.stamp) await take();
      document.body.classList.remove("ended");
    } catch (fault) {
      document.body.classList.add("ended");
    }
    setTimeout(look, every);
  }
  look();
})();
