// Runs the script of a page of answers with just so much of a browser as it needs; what it does is told as JSON.
"use strict";
const { sheet, script, typed, stored, storage, language } = JSON.parse(require("fs").readFileSync(0, "utf-8"));
const done = { files: [], told: [], focused: "", stored: stored || {}, asked: [] };

function element(more) {
  const heard = {};
  return Object.assign({
    hidden: true,
    addEventListener: (event, what) => { heard[event] = what; },
    fire: (event) => heard[event](),
    focus() { done.focused = this.name; },
    dispatchEvent() {},
  }, more);
}
const boxes = sheet.boxes.map((box) => element(Object.assign({ value: "", checked: false }, box)));
const main = element(), parts = { save: element(), wipe: element(), keeping: element() };
parts["sheet-data"] = { textContent: JSON.stringify(sheet.data) };
let shown = "at first";
parts.kept = { get textContent() { return shown; }, set textContent(text) { shown = text; done.told.push(text); } };
globalThis.document = {
  getElementById: (id) => parts[id],
  querySelectorAll: (wanted) => boxes.filter((box) => wanted === "[data-form]" ? false : !("data-cell" in box)),
  addEventListener() {},
  querySelector: () => main,
  body: { append() {} },
  dispatchEvent: () => true,
  createElement: () => ({ click() { done.files.push([this.download, this.href]); }, remove() {} }),
};
globalThis.confirm = (text) => { done.asked.push(text); return true; };
globalThis.Blob = function (pieces) { this.text = pieces.join(""); };
globalThis.URL = { createObjectURL: (blob) => blob.text, revokeObjectURL() {} };
globalThis.setTimeout = () => 0;
const own = {
  getItem: (key) => (key in done.stored ? done.stored[key] : null),
  setItem: (key, text) => { done.stored[key] = text; },
  removeItem: (key) => { delete done.stored[key]; },
};
Object.defineProperty(globalThis, "localStorage", {
  get() { if (storage === "refused") throw new Error("refused"); return own; },
});

(0, eval)(script);
done.hidden = parts.keeping.hidden;
done.restored = boxes.map((box) => (box.type === "text" ? box.value : box.checked));
for (const step of typed) {
  if (step === "save" || step === "wipe") { parts[step].fire("click"); continue; }
  const [name, value] = step;
  for (const box of boxes.filter((one) => one.name === name)) {
    if (box.type === "text") box.value = value;
    else box.checked = box.value === value || (box.type === "checkbox" && box.checked);
  }
  main.fire("input");
}
done.left = boxes.map((box) => (box.type === "text" ? box.value : box.checked));
console.log(JSON.stringify(done));
