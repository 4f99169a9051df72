// What the scans could not tell is typed here, kept in this browser and saved as a file. Nothing of a paper becomes markup.
(function () {
  "use strict";
  const data = JSON.parse(document.getElementById("queue-data").textContent);
  const cards = data.cards, byId = new Map(cards.map((card) => [card.id, card]));
  const state = new Map();  // by card: what stands in its box, and whether somebody confirmed it
  const shown = new Map();  // by card: its elements
  let lang = data.lang;
  const told = document.getElementById("told");

  function said(path) {
    const text = path.split(".").reduce((table, key) => (table === undefined ? undefined : table[key]), data.words[lang]);
    return text === undefined ? text : text.replace(/ ([:;?!%])/g, "\u00a0$1");
  }
  function fill(text, ...parts) { return parts.reduce((found, part, k) => found.split("{" + k + "}").join(part), text); }
  function make(tag, names, ...inside) {
    const one = document.createElement(tag);
    for (const [name, value] of Object.entries(names || {})) {
      if (name === "class") one.className = value; else if (value !== null && value !== undefined) one.setAttribute(name, value);
    }
    one.append(...inside.filter((piece) => piece !== null && piece !== ""));
    return one;
  }
  function why(card) { return said("waits." + card.waits) || fill(said("waits.other"), card.waits); }

  // ------------------------------------------------------------------ keeping
  function keep() {
    try {
      const kept = {};
      for (const [id, one] of state) if (one.touched) kept[id] = [one.text, one.done];
      localStorage.setItem(data.key, JSON.stringify(kept));
    } catch (fault) { document.getElementById("keeps").textContent = said("queue.not_kept"); }
  }
  function restore() {
    for (const card of cards) state.set(card.id, { text: card.candidate, done: false, touched: false });
    try {
      const kept = JSON.parse(localStorage.getItem(data.key)) || {};
      for (const [id, one] of Object.entries(kept)) {
        if (state.has(id) && Array.isArray(one) && typeof one[0] === "string") state.set(id, { text: one[0], done: one[1] === true, touched: true });
      }
    } catch (fault) { if (!(fault instanceof SyntaxError)) document.getElementById("keeps").textContent = said("queue.not_kept"); }
  }

  // ------------------------------------------------------------------ showing
  function picture(source, text) {
    const image = make("img", { src: source, alt: text, loading: "lazy" });
    image.addEventListener("click", () => image.classList.toggle("whole"));
    return image;
  }
  function heading(group) {
    if (group.sort !== "question") return said("queue." + group.sort);
    const unit = group.unit ? " – " + fill(said("queue.in_unit"), group.unit) : "";
    return fill(said("queue.question"), group.number) + " · " + (group.title[lang] || group.exercise) + " · " + group.part + unit;
  }
  function about(card) {
    const line = [card.student];
    if (card.coordinates > 1) line.push(fill(said("queue.of_coordinate"), card.coordinate, card.coordinates));
    return line.filter(Boolean).join(" · ");
  }
  function reading(card) {
    if (card.sort !== "question") return "";
    if (!card.candidate) return said("queue.nothing_read");
    const text = card.what === "number" ? card.candidate.replace(".", (0.5).toLocaleString(lang).charAt(1)) : card.candidate;
    return said("queue.was_read") + " " + text + ((card.waits === "digit" || card.waits === "doubted") && card.confidence ? " · " + fill(said("queue.sure"), card.confidence) : "");
  }
  function draw() {
    document.documentElement.lang = lang;
    document.title = said("queue.title");
    for (const one of document.querySelectorAll("[data-said]")) one.textContent = said(one.dataset.said);
    for (const one of document.querySelectorAll("[data-title]")) one.title = said(one.dataset.title);
    for (const one of document.querySelectorAll("[data-label]")) one.setAttribute("aria-label", said(one.dataset.label));
    for (const one of document.querySelectorAll("[data-lang]")) one.setAttribute("aria-pressed", String(one.dataset.lang === lang));
    const room = document.getElementById("cards");
    room.replaceChildren();
    shown.clear();
    for (const group of data.groups) {
      const own = cards.filter((card) => card.group === group.id);
      const section = make("section", {}, make("h2", {}, heading(group)));
      if (group.letters.length) section.append(make("p", { class: "small" }, fill(said("queue.letters"), group.letters.join(", "))));
      const likely = own.filter((card) => card.likely);
      for (const card of own) if (likely.length < 2 || !card.likely) section.append(cardOf(card));
      if (likely.length > 1) section.append(together(likely));
      room.append(section);
    }
    count();
  }
  // One tap confirms the readings that nobody has corrected; it stands behind the last picture.
  function together(likely) {
    const all = make("button", { type: "button", class: "main" }, fill(said("queue.confirm_all"), likely.length));
    all.addEventListener("click", () => {
      for (const card of likely) if (!state.get(card.id).touched) settle(card, true, false);
      nextOpen(likely[likely.length - 1]);
    });
    return make("div", { class: "likely" }, make("p", {}, fill(said("queue.likely"), likely.length)), ...likely.map(cardOf), make("p", { class: "buttons" }, all));
  }
  function cardOf(card) {
    const one = state.get(card.id);
    const crops = make("div", { class: ["free", "struck"].includes(card.waits) ? "crops from-right" : "crops" });
    card.crops.forEach((source, k) => crops.append(picture(source, card.crops.length > 1 ? fill(said("queue.scan"), k + 1) : about(card))));
    const pages = make("p", { class: "small" });
    card.pages.forEach((source, k) => pages.append(make("a", { href: source, target: "_blank", rel: "noopener" }, card.pages.length > 1 ? fill(said("queue.scan"), k + 1) : said("queue.page")), " "));
    const box = entry(card, one);
    const confirm = make("button", { type: "button", class: "main" }, said("queue.confirm"));
    const nothing = make("button", { type: "button", title: "Alt+N" }, card.sort === "pages" ? said("queue.not_a_page") : said("queue.nothing"));
    const typing = make("div", { class: "typing" }, box.element, confirm, card.sort === "names" ? "" : nothing);
    if (card.drawing) {
      const click = make("button", { type: "button" }, said("queue.click"));
      click.addEventListener("click", () => clicking(card));
      typing.append(click);
    }
    const read = reading(card);
    const lines = [make("h3", {}, about(card)), make("p", { class: "small" }, make("span", { class: "why" }, why(card)), read ? " · " + read : "")];
    const hint = make("p", { class: "small", role: "status" });
    const element = make("article", { class: "card", id: "c" + card.id }, ...lines, crops, typing, hint, pages);
    const parts = { element: element, box: box, confirm: confirm, hint: hint };
    shown.set(card.id, parts);
    confirm.addEventListener("click", () => { settle(card, !state.get(card.id).done, true); });
    nothing.addEventListener("click", () => { nothingThere(card); });
    mark(card);
    return element;
  }
  function entry(card, one) {
    if (card.sort === "pages") return paperEntry(card, one);
    const label = card.sort === "names" ? said("queue.whose_name") : heading(data.groups.find((g) => g.id === card.group)) + ", " + about(card);
    const input = make("input", { type: "text", autocomplete: "off", autocapitalize: "off", spellcheck: "false", "aria-label": label });
    input.value = one.text;
    input.addEventListener("input", () => change(card, input.value));
    return { element: input, focus: () => { input.focus({ preventScroll: true }); input.select(); }, show: (text) => { if (input.value !== text) input.value = text; } };
  }
  // A page is told by its paper and its number: the code of the paper, a space, and the number.
  function paperEntry(card, one) {
    const [code, number] = one.text.split(" ");
    const paper = make("select", { "aria-label": said("queue.paper") }, make("option", { value: "" }, "–"));
    for (const known of data.papers) paper.append(make("option", { value: known.code }, [known.student, known.title[lang] || "", known.code].filter(Boolean).join(" · ")));
    const which = make("select", { "aria-label": said("queue.which_page") });
    paper.value = code || "";
    function pages() {
      const known = data.papers.find((p) => p.code === paper.value);
      which.replaceChildren();
      for (let k = 1; k <= (known ? known.pages : 1); k++) which.append(make("option", { value: String(k) }, said("queue.which_page") + " " + k));
    }
    pages();
    if (number) which.value = number;
    paper.addEventListener("change", () => { pages(); change(card, paper.value ? paper.value + " " + which.value : ""); });
    which.addEventListener("change", () => change(card, paper.value ? paper.value + " " + which.value : ""));
    const whole = make("span", { class: "typing" }, make("span", { class: "small" }, said("queue.whose_page")), paper, which);
    return { element: whole, focus: () => paper.focus({ preventScroll: true }), show: () => { const [c, n] = state.get(card.id).text.split(" "); paper.value = c || ""; pages(); if (n) which.value = n; } };
  }
  function mark(card) {
    const parts = shown.get(card.id), one = state.get(card.id);
    parts.element.classList.toggle("is-done", one.done);
    parts.confirm.textContent = said(one.done ? "queue.take_back" : "queue.confirm");
    parts.confirm.classList.toggle("main", !one.done);
    parts.box.show(one.text);
    parts.hint.textContent = "";
  }
  function count() {
    const done = cards.filter((card) => state.get(card.id).done).length;
    const place = document.getElementById("done");
    place.textContent = !cards.length ? said("queue.nothing_waits") : done === cards.length ? said("queue.all_done") : fill(said("queue.done"), done, cards.length);
    document.getElementById("next").disabled = done === cards.length;
  }

  // ------------------------------------------------------------------ deciding
  function change(card, text) {
    const one = state.get(card.id);
    state.set(card.id, { text: text, done: false, touched: true });
    if (one.done) { mark(card); count(); }
    keep();
  }
  function nothingThere(card) { change(card, ""); settle(card, true, true, true); }
  // Where nothing was read, Enter alone does not say that nothing is written.
  function isUnsaid(card, one) { return !one.text.trim() && (card.sort !== "question" || !one.touched); }
  function settle(card, done, onwards, nothing) {
    const one = state.get(card.id);
    if (done && !nothing && isUnsaid(card, one)) {
      shown.get(card.id).hint.textContent = said("queue.unsaid_" + card.sort);
      return;
    }
    state.set(card.id, { text: one.text, done: done, touched: one.touched || done });
    mark(card);
    count();
    keep();
    if (done && onwards) go(card, 1);
  }
  function go(card, by) {
    const next = cards[cards.indexOf(card) + by];
    if (next) show(next); else if (by > 0) { told.textContent = ""; document.getElementById("save-typed").focus(); }
  }
  function show(card) {
    const parts = shown.get(card.id);
    parts.element.scrollIntoView({ block: "nearest" });
    parts.box.focus();
  }
  function nextOpen(after) {
    const start = after ? cards.indexOf(after) + 1 : 0;
    const found = cards.slice(start).concat(cards.slice(0, start)).find((card) => !state.get(card.id).done);
    if (found) show(found);
  }
  function current() {
    const element = document.activeElement && document.activeElement.closest(".card");
    return element ? byId.get(element.id.slice(1)) : undefined;
  }
  document.addEventListener("keydown", (event) => {
    if (document.getElementById("clicking").open) return;
    const card = current();
    if (event.altKey && event.code === "KeyJ") { event.preventDefault(); nextOpen(card); return; }
    if (!card) return;
    if (event.key === "Enter" && !event.target.closest("button, a")) {
      event.preventDefault();
      if (event.shiftKey) go(card, -1); else settle(card, true, true);
    } else if (event.altKey && event.code === "KeyN") { event.preventDefault(); nothingThere(card); }
    else if (event.key === "Escape") settle(card, false, false);
  });

  // ------------------------------------------------------------------ clicking points
  let points = null;
  function clicking(card) {
    const own = cards.filter((one) => one.drawing && one.drawing.source === card.drawing.source);
    const names = Array.from(new Set(own.map((one) => one.part)));
    points = { card: card, names: names, own: own, at: Math.max(0, names.indexOf(card.part)), marks: [] };
    document.getElementById("click-image").src = card.drawing.source;
    document.getElementById("click-help").textContent = fill(said("queue.click_help"), names.join(", "));
    step();
    document.getElementById("clicking").showModal();
  }
  function step() {
    const now = document.getElementById("click-now");
    now.textContent = points.at < points.names.length ? fill(said("queue.click_next"), points.names[points.at]) : said("queue.click_all");
    const marks = document.getElementById("click-marks"), wide = points.card.drawing.width, high = points.card.drawing.height;
    marks.setAttribute("viewBox", "0 0 " + wide + " " + high);
    marks.replaceChildren();
    for (const one of points.marks) {
      for (const [x1, y1, x2, y2] of [[one.x - 2, one.y, one.x + 2, one.y], [one.x, one.y - 2, one.x, one.y + 2]]) {
        const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
        for (const [name, value] of Object.entries({ x1: x1, y1: high - y1, x2: x2, y2: high - y2, stroke: "#c00", "stroke-width": ".4" })) line.setAttribute(name, value);
        marks.append(line);
      }
      const text = document.createElementNS("http://www.w3.org/2000/svg", "text");
      for (const [name, value] of Object.entries({ x: one.x + 1, y: high - one.y - 1, "font-size": "4", fill: "#c00" })) text.setAttribute(name, value);
      text.textContent = one.name;
      marks.append(text);
    }
  }
  document.getElementById("click-image").addEventListener("click", (event) => {
    if (!points || points.at >= points.names.length) return;
    const frame = event.currentTarget.getBoundingClientRect(), drawing = points.card.drawing;
    const x = (event.clientX - frame.left) / frame.width * drawing.width, y = (1 - (event.clientY - frame.top) / frame.height) * drawing.height;
    const name = points.names[points.at];
    points.marks.push({ x: x, y: y, name: name });
    for (const card of points.own.filter((one) => one.part === name)) {
      change(card, (card.coordinate === 1 ? x : y).toFixed(1));
      settle(card, true, false);
    }
    points.at += 1;
    step();
  });
  document.getElementById("click-undo").addEventListener("click", () => {
    const last = points && points.marks.pop();
    if (!last) return;
    points.at = points.names.indexOf(last.name);
    for (const card of points.own.filter((one) => one.part === last.name)) { change(card, card.candidate); settle(card, false, false); }
    step();
  });

  // ------------------------------------------------------------------ saving
  // A text that a spreadsheet would run gets an apostrophe before it.
  function inert(text) { return /^\s*[=+\-@]/.test(text) && /[(|!]/.test(text) ? "'" + text : text; }
  function csv(rows) {
    const line = (row) => row.map((cell) => inert(String(cell))).map((cell) => (/[",\r\n]/.test(cell) ? '"' + cell.split('"').join('""') + '"' : cell)).join(",");
    return "\ufeff" + rows.map((row) => line(row) + "\r\n").join("");
  }
  function typed() {
    return cards.filter((card) => state.get(card.id).done).map((card) => [...card.place, state.get(card.id).text, card.seen]);
  }
  // The texts of several coordinates as one answer; a unit behind one of them goes for all.
  function joined(one, texts) {
    if (texts.length === 1) return texts[0];
    if (texts.every((text) => !text.trim())) return "";
    const bare = texts.map((text) => (one.unit && text.endsWith(one.unit) ? text.slice(0, -one.unit.length) : text));
    const whole = one.patterns[bare.some((text, k) => text !== texts[k]) ? 1 : 0];
    return bare.reduce((found, text, k) => found.split(data.places[k]).join(text), whole).split("+ -").join("- ");
  }
  function answers() {
    const rows = data.answers.map((row) => row.slice()), of = (id) => state.get(id);
    for (const one of data.joins) {
      const isTyped = one.cards.every((id) => id === null || of(id).done);
      const texts = one.cards.map((id, k) => (id === null ? one.texts[k] : of(id).text));
      rows.push([...one.row, isTyped ? joined(one, texts) : one.waiting]);
    }
    return rows;
  }
  function save(name, rows) {
    const link = make("a", { download: name });
    link.href = URL.createObjectURL(new Blob([csv(rows)], { type: "text/csv" }));
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    const done = cards.filter((card) => state.get(card.id).done).length;
    told.textContent = fill(said("queue.saved"), name, done, cards.length);
  }
  // Where the command serves the page, what is typed goes straight back, and the page comes anew with what waits still.
  function send() {
    const sent = { method: "POST", headers: { "Content-Type": "text/csv" }, body: csv([data.typed_columns, ...typed()]) };
    fetch("../typed", sent).then(async (reply) => {
      if (reply.ok) location.reload(); else told.textContent = fill(said("queue.refused"), await reply.text());
    }).catch(() => { told.textContent = said("queue.ended"); });
  }
  const isServed = location.protocol === "http:";
  if (isServed) {
    document.getElementById("save-typed").dataset.said = "queue.send_typed";
    document.getElementById("keeps").dataset.said = "queue.sent_back";
  }
  document.getElementById("save-typed").addEventListener("click", () => isServed ? send() : save("typed.csv", [data.typed_columns, ...typed()]));
  document.getElementById("save-answers").addEventListener("click", () => save("answers.csv", [data.answer_columns, ...answers()]));
  document.getElementById("next").addEventListener("click", () => nextOpen(current()));
  for (const button of document.querySelectorAll("[data-lang]")) button.addEventListener("click", () => {
    const card = current();
    lang = button.dataset.lang;
    draw();
    if (card) show(card);
  });

  restore();
  draw();
})();
