// What is practice's own: the key Enter checks its question, what was said of an answer that changed since is old, a keyboard
// goes on at what came, the mechanism moves. What is typed is kept by keeping.js, which this hears and tells by events.
(function () {
  "use strict";
  const form = document.getElementById("sheet");
  if (!form) return;
  const own = form.dataset.keepOwn, said = JSON.parse(form.dataset.keepWords);
  const give = (event, detail) => form.dispatchEvent(new CustomEvent("keep:" + event, { detail: detail }));
  const isRead = (event) => /\/read$/.test(event.detail.requestConfig.path);

  form.addEventListener("kept:changed", (event) => {
    const told = document.querySelector("#told-" + CSS.escape(own + event.detail.name) + " p");
    if (!told || told.dataset.stale) return;
    told.dataset.stale = "1";
    told.append(" " + said.stale);
  });
  form.addEventListener("keydown", (event) => {
    const box = event.target;
    if (event.key !== "Enter" || box.tagName !== "INPUT" || !(box.name || "").startsWith(own)) return;
    const button = box.closest("li").querySelector("button[name=check]");
    if (!button) return;
    event.preventDefault();
    button.click();
  });

  // -------------------------------------------------------------- pieces that come
  let pressed = null;
  form.addEventListener("submit", (event) => { pressed = event.submitter; });
  document.body.addEventListener("htmx:sendError", (event) => { if (!isRead(event)) give("tell", { text: said.not_sent }); });
  document.body.addEventListener("htmx:responseError", (event) => {
    if ([401, 403].includes(event.detail.xhr.status) && !isRead(event)) give("renew");
  });
  // Signed in again in another page: what was pressed is pressed once more.
  form.addEventListener("kept:renewed", () => {
    const again = pressed;
    pressed = null;
    if (again && again.isConnected) again.click();
  });
  document.body.addEventListener("htmx:oobAfterSwap", () => {
    const came = document.querySelector("[data-focus]");
    if (!came) return;
    came.removeAttribute("data-focus");
    came.focus({ preventScroll: true });
    came.scrollIntoView({ block: "nearest" });
  });

  // The mechanism in motion comes when it is asked for; its own script then finds its numbers in the page.
  const motion = document.getElementById("motion");
  async function move(button) {
    const reply = await fetch(motion.dataset.piece, { headers: { "HX-Request": "true" } });
    if (!reply.ok || reply.redirected) throw new Error("no motion");
    motion.innerHTML = await reply.text();
    motion.focus();
    const data = motion.querySelector("#motion-data");
    if (!data) return;
    const script = document.createElement("script");
    script.src = motion.dataset.script;
    document.body.append(script);
    button.hidden = "answered" in data.dataset;  // otherwise it brings more, once all is answered
  }
  if (motion) {
    form.addEventListener("click", (event) => {
      const button = event.target.closest("button[value=motion]");
      if (!button) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      button.disabled = true;
      move(button).catch(() => give("tell", { text: said.offline })).finally(() => { button.disabled = false; });
    });
  }
})();
