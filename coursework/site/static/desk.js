// The desk: keys of the queue; what a press does is always a button or a link of the page.
(function () {
  "use strict";
  var half = false;

  function typing(target) {
    return target.closest("textarea, select, input:not([type=checkbox]):not([type=radio])");
  }

  function arm(on) {
    half = on;
    var told = document.querySelector(".halves");
    if (told) { told.hidden = !on; }
  }

  function press(selector) {
    var found = document.querySelector(selector);
    if (!found || found.disabled) { return false; }
    found.click();
    return true;
  }

  function seen(selector) {
    return Array.prototype.find.call(document.querySelectorAll(selector), function (one) { return one.offsetParent !== null; });
  }

  document.addEventListener("keydown", function (event) {
    if (event.ctrlKey || event.metaKey || event.altKey) { return; }
    if (event.key === "Enter" && event.target.matches("[data-cell]")) { event.preventDefault(); event.target.blur(); return; }
    if (event.key === "Escape" && typing(event.target)) { event.target.blur(); return; }
    if (typing(event.target)) { return; }
    var card = document.getElementById("card");
    if (!card) { return; }
    var digit = /^(?:Digit|Numpad)([0-9])$/.exec(event.code);
    var key = event.key.toLowerCase();
    var done = true;
    var cell = digit && document.querySelectorAll("#card [data-cell]")[digit[1] - 1];
    if (cell && cell.offsetParent !== null) {
      cell.focus();
      cell.select();
    } else if (event.key === "Enter") {
      done = !event.target.closest("a, button, summary") && Boolean(seen("#card [data-key=enter]")) && press("#card [data-key=enter]");
    } else if (digit) {
      var points = Number(digit[1]) + (half ? 0.5 : 0);
      arm(false);
      done = press("#card [data-points='" + points + "']");
    } else if (key === "h") {
      arm(!half);
    } else if (key === "c") {
      var box = card.querySelector("textarea[name=comment]");
      if (box) { box.focus(); }
    } else if (key === "x") {
      done = press("#card input[type=checkbox][name=all]");
    } else if (key === "e") {
      done = press("#card input[name=everywhere]");
    } else if (key === "f") {
      done = press("#card details.figure > summary");
    } else if (key === "?") {
      done = press("#card details.keys > summary");
    } else if (/^[arujk]$/.test(key)) {
      var button = seen("#card [data-key='" + key + "']");
      done = Boolean(button) && !button.disabled;
      if (done) { button.click(); }
    } else {
      return;
    }
    if (done) { event.preventDefault(); }
  });

  document.addEventListener("htmx:afterSwap", function (event) {
    if (event.detail.target && event.detail.target.id === "card") {
      arm(false);
      var heading = seen("#card [data-first]") || seen("#card h2");
      if (heading) { heading.focus({ preventScroll: true }); }
      if (heading && heading.select) { heading.select(); }
      window.scrollTo(0, Math.min(window.scrollY, document.getElementById("card").offsetTop));
    }
  });

  // Rows of a table that hold what is sought; a press on a heading sorts by its column.
  document.addEventListener("input", function (event) {
    if (!event.target.matches("[data-finds]")) { return; }
    seek(event.target);
  });

  document.addEventListener("change", function (event) {
    if (event.target.matches("[data-submits]")) { event.target.form.requestSubmit(); }
  });

  function plain(text) {
    return text.normalize("NFD").replace(/[\u0300-\u036f]/g, "").toLowerCase();
  }

  function seek(box) {
    var sought = plain(box.value.trim());
    document.querySelectorAll(box.dataset.finds + " tbody tr").forEach(function (row) {
      row.hidden = sought !== "" && plain(row.cells[0].textContent).indexOf(sought) < 0;
    });
  }

  document.addEventListener("htmx:afterSettle", function () {
    var box = document.querySelector("[data-finds]");
    if (box && box.value) { seek(box); }
  });
})();
