// A row of keys above the keyboard of a telephone: the signs of the part whose box has the focus, which keyboards of numbers lack.
// Boxes of lines grow with what is typed where a browser does not let them by itself.
(function () {
  "use strict";
  const bar = document.getElementById("keys");
  if (!bar) return;
  const touch = matchMedia("(pointer: coarse)");
  let box = null;

  function type(text) {
    if (!box) return;
    const before = box.value.slice(0, box.selectionStart);
    const times = /[\p{L}\p{N})]\p{M}?$/u.test(before) && /^\p{L}/u.test(text) ? "*" : "";
    box.setRangeText(times + text, box.selectionStart, box.selectionEnd, "end");
    box.dispatchEvent(new InputEvent("input", { bubbles: true, inputType: "insertText", data: "" }));
  }
  function key(shown, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.tabIndex = -1;
    made.textContent = shown;
    made.addEventListener("click", () => act(made));
    return made;
  }
  // Letters and back again: a unit, a word.
  function turn(made) {
    box.inputMode = box.inputMode === "text" ? "decimal" : "text";
    made.setAttribute("aria-pressed", String(box.inputMode === "text"));
    box.blur();
    box.focus();
  }
  function show(wanted) {
    if (wanted === box) return;
    box = wanted;
    const made = JSON.parse(box.dataset.keys).map(([shown, text]) => key(shown, () => type(text)));
    if ("number" in box.dataset) made.unshift(key(bar.dataset.letters, turn));
    bar.replaceChildren(...made);
    bar.hidden = false;
    place();
  }
  // The keyboard covers the page, and leaves the visual viewport.
  function place() {
    const seen = window.visualViewport;
    bar.style.bottom = seen ? Math.max(0, innerHeight - seen.height - seen.offsetTop) + "px" : "0";
  }
  bar.addEventListener("pointerdown", (event) => event.preventDefault());  // the box keeps the focus
  document.addEventListener("focusin", (event) => {
    if (!touch.matches || bar.contains(event.target)) return;
    if (event.target.dataset.keys) show(event.target);
    else { bar.hidden = true; box = null; }
  });
  document.addEventListener("focusout", (event) => {
    if (event.relatedTarget === null) setTimeout(() => { if (document.activeElement !== box) { bar.hidden = true; box = null; } }, 150);
  });
  if (window.visualViewport) for (const event of ["resize", "scroll"]) visualViewport.addEventListener(event, place);
  function ready() { document.querySelectorAll("[data-number]").forEach((one) => { one.inputMode = touch.matches ? "decimal" : "text"; }); }
  touch.addEventListener("change", ready);
  ready();

  if (!CSS.supports("field-sizing", "content")) {
    const grow = (area) => { area.rows = Math.max(area.rows, area.value.split("\n").length); };
    document.querySelectorAll("textarea").forEach(grow);
    document.addEventListener("input", (event) => { if (event.target.tagName === "TEXTAREA") grow(event.target); });
  }
})();
