// Keeps what is typed in this page on this device, and hands it in as a file. It touches the boxes and the storage alone.
(function () {
  "use strict";
  const sheet = JSON.parse(document.getElementById("sheet-data").textContent);
  const said = sheet.words;
  const boxes = Array.from(document.querySelectorAll("main input[name]:not([data-cell]), main textarea[name]"));
  const bar = document.getElementById("keeping"), told = document.getElementById("kept");

  function tell(text) { if (told.textContent !== text) told.textContent = text; }
  function filled(pattern, ...parts) { return parts.reduce((text, part, k) => text.replace("{" + k + "}", () => part), pattern); }
  function isTicked(box) { return box.type === "radio" || box.type === "checkbox"; }

  // What the boxes hold, by their names: a text, or the list of what is ticked.
  function typed() {
    const found = {};
    for (const box of boxes) {
      if (!isTicked(box)) { if (box.value !== "") found[box.name] = box.value; continue; }
      if (box.checked) (found[box.name] = found[box.name] || []).push(box.value);
    }
    return found;
  }
  function fill(kept) {
    for (const box of boxes) {
      const value = Object.prototype.hasOwnProperty.call(kept, box.name) ? kept[box.name] : "";
      if (isTicked(box)) box.checked = Array.isArray(value) && value.includes(box.value);
      else { box.value = typeof value === "string" ? value : ""; box.dispatchEvent(new Event("filled")); }
    }
    document.dispatchEvent(new Event("answers:filled"));
  }

  function keep() {
    const now = new Date();
    try {
      localStorage.setItem(sheet.key, JSON.stringify({ when: now.getTime(), typed: typed() }));
      tell(filled(said.kept, shown(now)));
    } catch (fault) { tell(said.not_kept); }
  }
  function shown(when) {
    return when.toLocaleString(sheet.lang, { day: "numeric", month: "long", hour: "2-digit", minute: "2-digit" });
  }
  function restore() {
    let kept = null;
    try {
      // A device may offer a storage that takes nothing.
      localStorage.setItem(sheet.key + " ?", "1");
      localStorage.removeItem(sheet.key + " ?");
      kept = JSON.parse(localStorage.getItem(sheet.key));
    } catch (fault) { if (!(fault instanceof SyntaxError)) { tell(said.not_kept); return; } }
    if (kept && kept.typed && typeof kept.typed === "object") {
      fill(kept.typed);
      tell(filled(said.kept, shown(new Date(+kept.when || 0))));
    }
  }
  function wipe() {
    if (!confirm(said.sure)) return;
    fill({});
    try { localStorage.removeItem(sheet.key); } catch (fault) { /* nothing was kept */ }
    tell(said.cleared);
  }

  // The file to hand in: for each exercise whose it is, which variant, and a text a part.
  function answers() {
    const found = typed(), student = sheet.student || (found.student || "").trim();
    return sheet.sheets.map((one) => {
      const texts = {};
      for (const part of one.parts) texts[part] = [].concat(found[one.own + part] || "").join(", ");
      return { student: student, exercise: one.exercise, seed: one.seed, lang: sheet.lang, answers: texts };
    });
  }
  function save() {
    const made = answers();
    if (!made[0].student) {
      tell(said.name_first);
      boxes.find((box) => box.name === "student").focus();
      return;
    }
    const name = (sheet.file + "-" + made[0].student).replace(/[^\p{L}\p{M}\p{N}_-]+/gu, "_").slice(0, 80) + ".json";
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([JSON.stringify(made, null, 1) + "\n"], { type: "application/json" }));
    link.download = name;
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    const texts = made.flatMap((one) => Object.values(one.answers));
    tell(filled(said.saved, name, String(texts.filter((text) => text.trim()).length), String(texts.length)));
  }

  restore();
  for (const event of ["input", "change"]) document.querySelector("main").addEventListener(event, keep);
  document.getElementById("save").addEventListener("click", save);
  document.getElementById("wipe").addEventListener("click", wipe);
  bar.hidden = false;
})();
