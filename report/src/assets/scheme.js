// Light or dark: what the system says, until the button says otherwise. Runs in the head, so that a page does not open in one
// scheme and turn to the other. Paper is always light: the dark style sheet is for screens.
(function () {
  "use strict";
  const KEY = "excavator-scheme";
  const MEDIA = { auto: "screen and (prefers-color-scheme: dark)", dark: "screen", light: "not all" };
  const system = matchMedia("(prefers-color-scheme: dark)");
  const dark = document.querySelector("style.dark");
  const listeners = [];
  let wanted = "auto";

  // A page that is opened from a file or in a frame may not be allowed to remember anything.
  function remembered() {
    try { return localStorage.getItem(KEY); } catch { return null; }
  }
  function remember() {
    try { localStorage.setItem(KEY, wanted); } catch { /* the choice holds until the page is closed */ }
  }
  function apply(media) {
    dark.media = media;
    listeners.forEach((listener) => listener());
  }
  // From "auto" the first press must change something: the other scheme comes before the one of the system.
  function next() {
    const [own, other] = system.matches ? ["dark", "light"] : ["light", "dark"];
    return { auto: other, [other]: own, [own]: "auto" }[wanted];
  }
  function show(button) {
    button.textContent = `Colours: ${wanted}`;
    button.title = `Change to ${next()}`;
  }

  if (remembered() in MEDIA) wanted = remembered();
  dark.media = MEDIA[wanted];
  document.addEventListener("DOMContentLoaded", () => {
    const button = document.querySelector(".scheme");
    button.hidden = false;
    show(button);
    button.addEventListener("click", () => {
      wanted = next();
      remember();
      show(button);
      apply(MEDIA[wanted]);
    });
    system.addEventListener("change", () => { show(button); apply(MEDIA[wanted]); });
  });

  globalThis.scheme = {
    onChange(listener) { listeners.push(listener); },
    // Canvases are printed as they are drawn, so they are drawn in light colours first.
    print() { apply("not all"); },
    printed() { apply(MEDIA[wanted]); },
  };
})();
