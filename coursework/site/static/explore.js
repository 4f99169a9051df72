// Explore: a slider beside each number. What either says goes to the other; the form brings the rest by itself.
(function () {
  "use strict";
  document.querySelectorAll("#explore input[type=range]").forEach((slider) => {
    const box = document.getElementById(slider.dataset.of);
    slider.hidden = false;
    slider.addEventListener("input", () => { box.value = slider.value; });
    box.addEventListener("input", () => { if (box.value !== "") slider.value = box.value; });
  });
})();
