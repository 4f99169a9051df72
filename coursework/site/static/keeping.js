// Keeps what is typed in a form: on this device at every keystroke, in the database a moment later, and once the line is back.
//
// Of a page it needs, and of practice and assignments alike:
//   <body data-person="7" hx-headers='{"X-Seal": …}'>   who is signed in, and the seal of the session
//   <form data-keep="ADDRESS"              takes what changed, by POST (coursework/site/frame/keeping.py)
//         data-keep-as="PERSON SHEET"      whose and which sheet it is
//         data-keep-own="a-"               if wanted: what the names of its boxes begin with; it is not sent
//         data-keep-versions='{"rA": 3}'   the version of each box as the page was made; none is 0
//         data-keep-words='{"saving": …}'> sentences of [keeping] of the site's words
//   boxes: inputs, areas and selections with a name that does not begin with "_"; ticked ones of one name are one box
//   <p data-kept role="status"></p>        in the form, if wanted: what is told of saving
//   <input type="hidden" data-versions>    in the form, if wanted: the versions, for a server to which the form itself is sent
//   [data-read="NAME"], [data-other="NAME"]  in the form, if wanted: where "read as", and what another page wrote, stand
//   <p data-kept-left='{"left_sent": …}'>       of a list of sheets: what pages left on this device is sent, and that is told
// A form gives: kept:changed {name}, kept:acknowledged {versions, left}, and kept:renewed once a seal that was asked for by
// keep:renew is there; it takes keep:tell {text}. A form that is put in place later, by htmx, is found when it has settled.
//
// Every page load keeps under a key of its own, so that two pages without a line never overwrite one another. Versions are
// counted by the server: no clock of a device decides. Where two texts meet, both stand there until somebody chooses.
(function () {
  "use strict";
  const PAUSE = 700, FIRST = 2000, LONGEST = 60000, BEACON = 50000, HANGS = 20000, TRIED = 20;
  const LOAD = Math.random().toString(36).slice(2) + Date.now().toString(36);
  const keepers = new WeakMap();

  const isTicked = (box) => box.type === "radio" || box.type === "checkbox";
  const own = (table, name) => Object.prototype.hasOwnProperty.call(table, name);
  const union = (...lists) => Array.from(new Set(lists.flat()));
  const only = (table, wanted) => Object.fromEntries(Object.entries(table).filter(wanted));
  const some = (table) => Object.keys(table).length > 0;

  // ------------------------------------------------------------------ this device
  const device = {
    text(key) { try { return localStorage.getItem(key); } catch (fault) { return null; } },
    read(key) { try { return sound(JSON.parse(localStorage.getItem(key))); } catch (fault) { return null; } },
    write(key, value) { try { localStorage.setItem(key, JSON.stringify(value)); return true; } catch (fault) { return false; } },
    drop(key) { try { localStorage.removeItem(key); return true; } catch (fault) { return false; } },
    // What pages left, the earlier typed first: keys, and what stands there.
    left(begin) {
      let keys = [];
      try { keys = Object.keys(localStorage).filter((key) => key.startsWith(begin)); } catch (fault) { /* it may not be asked */ }
      const found = keys.map((key) => [key, device.read(key)]).filter(([, kept]) => kept);
      return found.sort((one, other) => (one[1].when || 0) - (other[1].when || 0));
    },
  };
  // What was kept as it is used: of each box a text, the version that it was written over, what was sent of it without an
  // answer, and what other pages wrote, which is still to be chosen from.
  function sound(kept) {
    if (!kept || typeof kept.keep !== "string" || !kept.keep.startsWith("/") || typeof kept.boxes !== "object") return null;
    const boxes = {};
    for (const [name, one] of Object.entries(kept.boxes || {})) {
      if (one && typeof one.text === "string") boxes[name] = entry(one.text, one.over, one.tried, one.beside);
    }
    return { ...kept, boxes: boxes };
  }
  const entry = (text, over, tried, beside) =>
    ({ text: text, over: Number(over) || 0, tried: Array.from(tried || []), beside: Array.from(beside || []) });

  // ---------------------------------------------------------------------- the line
  const sealOf = (page) => JSON.parse(page.body.getAttribute("hx-headers") || "{}")["X-Seal"] || "";
  let seal = sealOf(document);

  // A page that stayed open while somebody signed in anew takes over the seal of the new session, if it is theirs.
  async function renew() {
    let reply, text;
    try {
      reply = await fetch(location.pathname, { credentials: "same-origin" });
      text = await reply.text();
    } catch (fault) { return "offline"; }
    if (reply.status >= 500 || reply.status === 429) return "trouble";
    const page = new DOMParser().parseFromString(text, "text/html"), whose = document.body.dataset.person;
    if (!whose || page.body.dataset.person !== whose || !sealOf(page)) return "signed_out";
    seal = sealOf(page);
    document.body.setAttribute("hx-headers", JSON.stringify({ "X-Seal": seal }));
    document.querySelectorAll("input[name=_seal]").forEach((field) => { field.value = seal; });
    return "";
  }

  async function asked(address, boxes, leaving) {
    const body = new URLSearchParams();
    for (const [name, one] of Object.entries(boxes)) { body.append("text." + name, one.text); body.append("over." + name, one.over); }
    const how = { method: "POST", body: body, credentials: "same-origin", redirect: "error", headers: { "X-Seal": seal, "Accept": "application/json" } };
    if (leaving) how.keepalive = String(body).length < BEACON;
    else if (window.AbortSignal && AbortSignal.timeout) how.signal = AbortSignal.timeout(HANGS);
    try {
      const reply = await fetch(address, how);
      const is_json = (reply.headers.get("content-type") || "").startsWith("application/json");
      return { status: reply.status, after: 1000 * reply.headers.get("retry-after") || 0, told: is_json ? await reply.json() : null };
    } catch (fault) { return { status: 0, after: 0, told: null }; }
  }

  // What became of boxes that were sent. ``fault`` is empty, or the name of the sentence that says why nothing was taken:
  // offline, trouble and signed_out are tried again, closed and refused are not.
  async function post(address, boxes, leaving) {
    let found = await asked(address, boxes, leaving);
    if (!leaving && (found.status === 401 || found.status === 403)) {
      const fault = await renew();
      if (fault) return { fault: fault };
      found = await asked(address, boxes);
    }
    const { status, told, after } = found;
    if (status === 200 && told) return { fault: "", refused: [], ...told };
    if (status === 0) return { fault: "offline" };
    if (status === 401 || (leaving && status === 403)) return { fault: "signed_out" };
    if (status === 409) return { fault: "closed", says: told && told.told };
    if (status < 400 || status >= 500 || [408, 425, 429].includes(status)) return { fault: "trouble", after: after };
    return [400, 413, 422].includes(status) && Object.keys(boxes).length > 1 ? alone(address, boxes) : { fault: "refused" };
  }
  // One box that cannot be taken holds up no other.
  async function alone(address, boxes) {
    const all = { fault: "", versions: {}, others: {}, read: {}, refused: [] };
    for (const [name, one] of Object.entries(boxes)) {
      const told = await post(address, { [name]: one });
      if (told.fault === "refused") { all.refused.push(name); continue; }
      if (told.fault) return told;
      for (const what of ["versions", "others", "read"]) Object.assign(all[what], told[what]);
    }
    return all.refused.length === Object.keys(boxes).length ? { fault: "refused" } : all;
  }

  // Somebody who sends again and again: at growing pauses, no two devices of a class at once.
  class Sender {
    constructor(told, said) { this.told = told; this.said = said; this.timer = 0; this.wait = FIRST; }
    soon(pause) { clearTimeout(this.timer); this.timer = setTimeout(() => this.send(), pause); }
    again(after) {
      this.soon(Math.max(after || 0, this.wait) * (0.75 + Math.random() / 2));
      this.wait = Math.min(2 * this.wait, LONGEST);
    }
    back() { this.wait = FIRST; this.soon(300 * Math.random()); }
    tell(text, href, link) {
      if (!this.told || !text || this.told.dataset.told === text) return;
      this.told.dataset.told = this.told.textContent = text;
      if (!href) return;
      const anchor = document.createElement("a");
      anchor.href = href; anchor.textContent = link;
      if (href === "/sign-in") anchor.target = "_blank";
      this.told.append(" ", anchor);
    }
  }

  // ------------------------------------------------------------------------ boxes
  const boxesOf = (form) => Array.from(form.elements).filter((box) =>
    box.name && box.name[0] !== "_" && box.name.startsWith(form.dataset.keepOwn || "") &&
    box.matches("input:not([data-cell]), textarea, select") && !["hidden", "file", "submit"].includes(box.type));
  const nameOf = (form, box) => box.name.slice((form.dataset.keepOwn || "").length);

  // What stands in the boxes, a text a name; of ticks their values in order. Or what stood there as the page was made.
  function typed(form, asMade) {
    const found = {};
    for (const box of boxesOf(form)) {
      const name = nameOf(form, box);
      if (!own(found, name)) found[name] = "";
      if (isTicked(box)) { if (asMade ? box.defaultChecked : box.checked) found[name] += (found[name] && ", ") + box.value; }
      else found[name] = (asMade ? madeValue(box) : box.value).replace(/\r\n/g, "\n");
    }
    return found;
  }
  function madeValue(box) {
    if (box.tagName !== "SELECT") return box.defaultValue;
    return (Array.from(box.options).find((one) => one.defaultSelected) || box.options[0] || { value: "" }).value;
  }
  function fill(form, name, text) {
    const ticked = text.split(", ");
    for (const box of boxesOf(form)) {
      if (nameOf(form, box) !== name) continue;
      if (isTicked(box)) box.checked = ticked.includes(box.value);
      else { box.value = text; box.dispatchEvent(new Event("filled")); }
    }
  }

  class Keeper extends Sender {
    constructor(form) {
      super(form.querySelector("[data-kept]"), JSON.parse(form.dataset.keepWords || "{}"));
      this.form = form;
      this.key = "coursework " + form.dataset.keepAs + " " + LOAD;
      this.versions = JSON.parse(form.dataset.keepVersions || "{}");
      this.known = typed(form, true);  // what the server has
      this.pending = {};               // what it has not
      this.when = 0;                   // of the last typing: of what two pages left, the later typed stands in the box
      this.flights = 0;
      this.isTold = false;             // what was pressed said why nothing came of it: that stays until more is typed
      form.addEventListener("keep:tell", (event) => { this.tell(event.detail.text); this.isTold = true; });
      form.addEventListener("keep:renew", () => this.renew());
      this.restore();
      this.recall().catch(() => undefined);
    }
    give(event, detail) { this.form.dispatchEvent(new CustomEvent("kept:" + event, { bubbles: true, detail: detail })); }
    async renew() {
      const fault = await renew();
      if (fault) this.fail({ fault: fault });
      else { this.give("renewed", {}); this.back(); }
    }

    // ------------------------------------------------------------ on this device
    // What was saved since a page was made lies beside the page that the service worker keeps, and goes with it.
    async beside(act) {
      const name = "pages " + document.body.dataset.person;
      if (!window.caches || !await caches.has(name)) return;
      const cache = await caches.open(name), page = await cache.match(location.pathname);
      if (page) await act(cache, location.pathname + "?saved", { "offline-until": page.headers.get("offline-until") });
    }
    async recall() {
      await this.beside(async (cache, place) => {
        const found = await cache.match(place), { versions, texts } = found ? await found.json() : { versions: {} };
        for (const [name, version] of Object.entries(versions)) {
          if (!own(this.known, name) || version <= (this.versions[name] || 0)) continue;
          this.versions[name] = version;
          this.known[name] = texts[name];
          if (own(this.pending, name)) continue;
          fill(this.form, name, texts[name]);
          this.give("changed", { name: name });
        }
        this.state();
      });
    }
    remember() {
      const saved = JSON.stringify({ versions: this.versions, texts: this.known });
      this.beside((cache, place, headers) => cache.put(place, new Response(saved, { headers: headers }))).catch(() => undefined);
    }
    store() {
      if (!some(this.pending)) return device.drop(this.key);
      const page = { page: location.pathname, title: document.title, keep: this.form.dataset.keep };
      return device.write(this.key, { ...page, when: this.when, boxes: this.pending });
    }
    // What earlier pages of this sheet left is taken up, and forgotten where it stood once it stands under the own key.
    restore() {
      const left = device.left("coursework " + this.form.dataset.keepAs + " ").filter(([key]) => key !== this.key);
      for (const [, kept] of left) for (const [name, one] of Object.entries(kept.boxes)) this.takeUp(name, one);
      if (!left.length) return;
      this.when = left[left.length - 1][1].when || 0;
      if (!this.store()) { this.tell(this.said.not_here); return; }
      for (const [key, kept] of left) {
        const gone = only(kept.boxes, ([name]) => !own(this.known, name));  // boxes that this page has not
        if (some(gone)) device.write(key, { ...kept, boxes: gone }); else device.drop(key);
      }
      if (some(this.pending)) { this.tell(this.said.saving); this.soon(0); }
    }
    takeUp(name, one) {
      if (!own(this.known, name)) return;
      const now = this.versions[name] || 0, before = this.pending[name];
      if (!before && one.text === this.known[name] && !one.beside.length) return;
      const found = entry(one.text, one.over, one.tried, union(before ? [before.text, ...before.beside] : [], one.beside));
      if (before && before.text === one.text) { found.over = Math.max(found.over, before.over); found.tried = union(before.tried, one.tried); }
      if (found.over < now && !found.tried.includes(this.known[name])) found.beside.push(this.known[name]);
      else found.over = Math.max(found.over, now);  // a page that was kept is older than what was typed on it
      found.beside = union(found.beside).filter((text) => text !== found.text);
      if (!found.beside.length && found.text === this.known[name]) { delete this.pending[name]; return; }
      this.pending[name] = found;
      fill(this.form, name, found.text);
      this.give("changed", { name: name });
      this.ask(name);
    }
    changed() {
      let any = false;
      for (const [name, text] of Object.entries(typed(this.form))) {
        const waits = this.pending[name];
        if (waits ? waits.text === text : this.known[name] === text) continue;
        this.pending[name] = waits ? entry(text, waits.over, waits.tried, waits.beside) : entry(text, this.versions[name]);
        this.give("changed", { name: name });
        any = true;
        this.when = Date.now();
      }
      const stored = this.store();
      if (any) this.isTold = false;
      if (any) this.tell(stored ? this.said.saving : this.said.not_here);
      this.soon(PAUSE);
    }

    // ------------------------------------------------------------------- sending
    async send(leaving) {
      const sent = only(this.pending, ([, one]) => !one.beside.length && one.refused !== one.text);
      if (!some(sent) || (this.flights && !leaving)) return;
      for (const one of Object.values(sent)) one.tried = union(one.tried.filter((text) => text !== one.text), [one.text]).slice(-TRIED);
      this.store();
      const texts = Object.fromEntries(Object.entries(sent).map(([name, one]) => [name, { text: one.text, over: one.over }]));
      this.flights += 1;
      const told = await post(this.form.dataset.keep, texts, leaving);
      this.flights -= 1;
      if (told.fault) this.fail(told); else this.acknowledged(texts, told);
    }
    fail(told) {
      const stored = this.store(), said = this.said;
      if (told.fault === "signed_out") this.tell(said.signed_out, "/sign-in", said.sign_in);
      else if (told.fault === "offline") { if (!this.isTold || !stored) this.tell(stored ? said.offline : said.nowhere); }
      else this.tell(told.says || said[told.fault]);
      if (!["closed", "refused"].includes(told.fault)) this.again(told.after);
    }
    acknowledged(sent, told) {
      this.wait = FIRST;
      for (const [name, one] of Object.entries(sent)) {
        const now = this.pending[name], other = told.others[name];
        if (told.refused.includes(name)) { if (now) now.refused = one.text; continue; }
        const version = other ? other.version : told.versions[name];
        if (version < (this.versions[name] || 0)) continue;  // an answer that comes after a later one
        this.known[name] = other ? other.text : one.text;
        this.versions[name] = version;
        if (!now) continue;
        if (now.text === this.known[name] && !now.beside.length) { delete this.pending[name]; continue; }
        // What this page sent itself, and had no answer to, is nobody else's.
        if (!other || now.tried.includes(other.text)) {
          now.over = version;
          if (!other && !this.flights) now.tried = [];
          continue;
        }
        now.beside = union(now.beside, [other.text]);
        this.ask(name);
      }
      for (const [name, text] of Object.entries(told.read || {})) this.read(name, text);
      this.settled();
    }
    // The versions that a form sends of itself; of a box that waits for a choice, the one that was written over.
    state() {
      const field = this.form.querySelector("[data-versions]"), held = only(this.pending, ([, one]) => one.beside.length);
      const over = Object.fromEntries(Object.entries(held).map(([name, one]) => [name, one.over]));
      if (field) field.value = JSON.stringify({ ...this.versions, ...over });
      return held;
    }
    settled() {
      this.store();
      this.remember();
      const left = Object.values(this.pending), held = this.state();
      if (left.some((one) => !one.beside.length && one.refused !== one.text)) this.soon(0);
      else if (some(held)) this.tell(this.said.other);
      else this.tell(left.length ? this.said.refused : this.said.kept);
      this.give("acknowledged", { versions: this.versions, left: left.length });
    }

    // --------------------------------------------------------------- beside a box
    first(name) { return boxesOf(this.form).find((one) => nameOf(this.form, one) === name); }
    place(name, kind) {
      const box = this.first(name);
      if (!box) return null;
      const found = this.form.querySelector("[data-" + kind + "=" + JSON.stringify(box.name) + "]");
      if (found) return found;
      const made = document.createElement("div");
      made.className = kind === "read" ? "read-as" : "other-page";
      made.id = kind + "-" + box.name;
      made.setAttribute("data-" + kind, box.name);
      if (kind === "other") made.setAttribute("role", "alert");
      else if (!isTicked(box)) box.setAttribute("aria-describedby", made.id);
      (box.closest("fieldset") || box.closest(".box, .cells") || box).after(made);
      return made;
    }
    read(name, html) { const place = this.place(name, "read"); if (place) place.innerHTML = html; }
    // What other pages wrote stands beside one's own until one is chosen.
    ask(name) {
      const texts = this.pending[name].beside, place = this.place(name, "other");
      if (!place || !texts.length) return;
      const button = (said, text) => {
        const made = document.createElement("button");
        made.type = "button"; made.textContent = said;
        made.addEventListener("click", () => this.choose(name, text));
        return made;
      };
      const pieces = texts.flatMap((text) => {
        const says = document.createElement("span");
        says.textContent = this.said.other_wrote.replace("{0}", () => text || this.said.nothing);
        return [says, button(this.said.take, text)];
      });
      place.replaceChildren(...pieces, button(this.said.keep_mine));
    }
    choose(name, text) {
      const over = this.versions[name] || 0, place = this.place(name, "other"), box = this.first(name);
      if (text !== undefined) { fill(this.form, name, text); this.give("changed", { name: name }); }
      const chosen = typed(this.form)[name];
      if (chosen === this.known[name]) delete this.pending[name];
      else this.pending[name] = entry(chosen, over);
      place.replaceChildren();
      if (box) box.focus();
      this.settled();
    }
  }

  // ------------------------------------------- a list of sheets: what was left is sent
  class Left extends Sender {
    constructor(place) { super(place, JSON.parse(place.dataset.keptLeft)); this.soon(0); }
    async send() {
      if (this.busy) return;
      this.busy = true;
      const found = { sent: 0, other: null, closed: null, fault: null };
      for (const [key, kept] of device.left("coursework " + document.body.dataset.person + " ")) {
        if (!await this.carry(key, kept, found)) break;
      }
      this.busy = false;
      if (found.fault) this.again(found.fault.after);
      if (found.other) this.tell(this.said.left_other, found.other.page, found.other.title);
      else if (found.closed) this.tell(this.said.left_closed, found.closed.page, found.closed.title);
      else if (found.sent) this.tell(this.said.left_sent);
      else if (found.fault) this.tell(this.said.left_waits);
    }
    // Sends what one page left; whether others may be sent as well.
    async carry(key, kept, found) {
      const stood = device.text(key), free = only(kept.boxes, ([, one]) => !one.beside.length);
      const told = some(free) ? await post(kept.keep, free) : { fault: "", versions: {}, others: {}, refused: [] };
      if (["closed", "refused"].includes(told.fault)) {  // nothing of it is thrown away; it is told once
        if (!kept.told) { found.closed = kept; if (device.text(key) === stood) device.write(key, { ...kept, told: true }); }
        return true;
      }
      if (told.fault) { found.fault = told; return false; }
      const left = only(kept.boxes, ([name]) => !own(told.versions, name));
      const same = device.text(key) === stood;  // else a page that is still open has gone on since
      if (same) { if (some(left)) device.write(key, { ...kept, boxes: left }); else device.drop(key); }
      if (some(told.versions)) found.sent += 1;
      if (!some(left)) return true;
      const mine = only(told.others, ([name, other]) => own(left, name) && left[name].tried.includes(other.text));
      if (same && some(mine)) {
        const over = Object.entries(left).map(([name, one]) => [name, own(mine, name) ? { ...one, over: mine[name].version, tried: [] } : one]);
        const again = { ...kept, boxes: Object.fromEntries(over) };
        return device.write(key, again) && this.carry(key, again, found);
      }
      found.other = kept;
      return true;
    }
  }

  // ------------------------------------------------------------------- what happens
  function keeperOf(form) {
    if (!keepers.has(form)) keepers.set(form, new Keeper(form));
    return keepers.get(form);
  }
  function all() { return Array.from(document.querySelectorAll("form[data-keep]"), keeperOf); }
  const lists = Array.from(document.querySelectorAll("[data-kept-left]"), (place) => new Left(place));
  const leave = () => all().forEach((one) => { one.store(); one.send(true); });
  const back = () => [...all(), ...lists].forEach((one) => one.back());
  for (const event of ["input", "change"]) {
    document.addEventListener(event, (one) => {
      const form = one.target.form;
      if (form && form.matches("form[data-keep]")) keeperOf(form).changed();
    });
  }
  document.addEventListener("submit", (one) => {
    if (!one.target.matches("form[data-keep]")) return;
    keeperOf(one.target).changed();
    keeperOf(one.target).soon(0);
  });
  document.addEventListener("htmx:afterSettle", all);
  document.addEventListener("visibilitychange", () => { if (document.visibilityState === "hidden") leave(); else back(); });
  window.addEventListener("pagehide", leave);
  window.addEventListener("pageshow", (one) => { if (one.persisted) { all().forEach((keeper) => keeper.store()); back(); } });
  window.addEventListener("online", back);
  all();
})();
