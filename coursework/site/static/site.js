// What all pages share. Each page works without it.
(function () {
  "use strict";
})();
