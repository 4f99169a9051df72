// A toolbar is one stop of the keyboard, at the chosen tool or the first name that is not placed yet; arrow keys, Home and
// End move inside.
document.querySelectorAll("[role=toolbar]").forEach(bar => {
  "use strict";
  const tools = [...bar.querySelectorAll("button")];
  function settle() {
    const stop = tools.find(one => one === document.activeElement) || tools.find(one => one.matches("[data-tool][aria-pressed=true], [data-name]:not(.placed)")) || tools[0];
    for (const one of tools) one.tabIndex = one === stop ? 0 : -1;
  }
  bar.addEventListener("keydown", e => {
    const k = tools.indexOf(e.target), to = { ArrowLeft: k - 1, ArrowRight: k + 1, Home: 0, End: -1 }[e.key];
    if (to === undefined || e.altKey || e.ctrlKey || e.metaKey) return;
    e.preventDefault();
    tools.at(to % tools.length).focus();
  });
  for (const moved of ["focusin", "focusout"]) bar.addEventListener(moved, settle);
  new MutationObserver(settle).observe(bar, { subtree: true, attributeFilter: ["aria-pressed"] });
  settle();
});
