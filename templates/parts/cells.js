// The boxes of components and the one line that is handed in: each follows the other. The line says by data-form what text the
// components make, "({} ; {})", as coursework/sheets/cells.py does with a form without a script.
(function () {
  "use strict";
  const named = (name) => document.getElementsByName(name)[0];
  const pieces = (line) => line.dataset.form.split("{}");
  const cells = (line) => pieces(line).slice(1).map((_, index) => named(line.name + "-" + (index + 1)));
  const plain = (text) => text.replace(/\s+/g, " ").trim();
  const escaped = (text) => text.trim().replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

  function joined(line) {
    const texts = cells(line).map((cell) => plain(cell.value));
    return texts.some(Boolean) ? pieces(line).map((piece, index) => piece + (texts[index] || "")).join("") : "";
  }
  // The components of a text in the order of the boxes; nothing of a text that has another number of them.
  function components(text, line) {
    const match = new RegExp("^\\s*" + pieces(line).map(escaped).join("\\s*([^;=\\[\\]\\n]*)\\s*") + "\\s*$").exec(text);
    if (match) return match.slice(1).map(plain);
    if (text.includes("=") || text.includes("\\")) return null;
    const count = pieces(line).length - 1;
    const rows = text.replace(/[([{]/g, " ").split(/[;|\n\t)\]}]/).map(plain).filter((row) => /[^\s,]/.test(row));
    const cut = (by) => rows.map((row) => row.split(by).filter(Boolean));
    const found = [rows.map((row) => [row]), cut(/,?\s+,?/), cut(/[\s,]+/)].find((one) => one.flat().length === count && one.flat().every((piece) => /\d|π/.test(piece)));
    if (!found) return null;
    const turned = "down" in line.dataset && found.length === 3 && found.every((row) => row.length === 2);
    return turned ? [0, 1].flatMap((column) => found.map((row) => row[column])) : found.flat();
  }
  function fill(line, texts) { cells(line).forEach((cell, index) => { cell.value = texts ? texts[index] : ""; }); }
  // A drawing, too, hears of the line by its own name.
  let tells = false;
  function tell(line) {
    line.value = joined(line);
    tells = true;
    line.dispatchEvent(new Event("input", { bubbles: true }));
    tells = false;
  }
  function spread(line) { fill(line, components(line.value, line)); }

  // Before all other listeners: these read the line.
  document.addEventListener("input", (event) => {
    const box = event.target;
    if (tells) return;
    if (box.dataset.form) { spread(box); return; }
    if (!box.dataset.cell) return;
    const line = named(box.dataset.cell);
    const whole = event.inputType !== "insertText" || (event.data || "").length > 1 ? components(box.value, line) : null;
    if (whole) fill(line, whole);
    tell(line);
  }, true);
  document.addEventListener("paste", (event) => {
    const line = event.target.dataset && event.target.dataset.cell && named(event.target.dataset.cell);
    const whole = line && components(event.clipboardData.getData("text"), line);
    if (!whole) return;
    event.preventDefault();
    fill(line, whole);
    tell(line);
  });
  document.addEventListener("filled", (event) => { if (event.target.dataset.form) spread(event.target); }, true);
  document.querySelectorAll("[data-form]").forEach((line) => {
    if (line.value) spread(line);
    else line.value = line.defaultValue = joined(line);
  });
})();
