// The page around the plots: contents, wide tables, printing.
(function () {
  "use strict";
  // The section that is read is marked in the contents.
  const links = new Map(Array.from(document.querySelectorAll("nav a"), (link) => [link.hash.slice(1), link]));
  const sections = Array.from(document.querySelectorAll("section"));
  function mark() {
    const read = sections.filter((section) => section.getBoundingClientRect().top < innerHeight / 3).pop();
    links.forEach((link, anchor) => {
      if (!read || anchor !== read.id) { link.removeAttribute("aria-current"); return; }
      if (link.hasAttribute("aria-current")) return;
      link.setAttribute("aria-current", "true");
      // On a narrow screen the contents are one line that scrolls by itself.
      if (bar.scrollWidth > bar.clientWidth) bar.scrollLeft = link.offsetLeft - bar.clientWidth / 3;
    });
  }
  const bar = document.querySelector("nav");
  if (bar) {
    // A heading that is jumped to must not end up under the bar, which is as high as its links need.
    const measure = () => document.documentElement.style.setProperty("--bar", `${bar.offsetHeight}px`);
    measure();
    new ResizeObserver(measure).observe(bar);
    let due = false;
    window.addEventListener("scroll", () => {
      if (due) return;
      due = true;
      requestAnimationFrame(() => { due = false; mark(); });
    }, { passive: true });
    mark();
  }

  // What is wider than the window scrolls, by keyboard too.
  const wide = Array.from(document.querySelectorAll(".wide"));
  function nameOf(box) {
    const heading = box.closest("section")?.querySelector("h2");
    return heading ? `${heading.textContent}, scrolls sideways` : "Scrolls sideways";
  }
  function reach() {
    wide.forEach((box) => {
      const scrolls = box.scrollWidth > box.clientWidth;
      if (scrolls === box.hasAttribute("tabindex")) return;
      if (scrolls) {
        box.tabIndex = 0;
        box.setAttribute("role", "group");
        box.setAttribute("aria-label", nameOf(box));
      } else {
        ["tabindex", "role", "aria-label"].forEach((name) => box.removeAttribute(name));
      }
    });
  }
  const watcher = new ResizeObserver(reach);
  wide.forEach((box) => watcher.observe(box));
  reach();

  // Width of plots on A4, px, and the part of their height with which two signals share a page.
  const PAPER = 680;
  const LOW = 0.8;
  let folded = [];
  window.addEventListener("beforeprint", () => {
    scheme.print();
    timePlots.fit(PAPER, LOW);
    folded = Array.from(document.querySelectorAll("details:not([open])"));
    folded.forEach((one) => { one.open = true; });
  });
  window.addEventListener("afterprint", () => {
    scheme.printed();
    timePlots.fit();
    folded.forEach((one) => { one.open = false; });
  });
})();
