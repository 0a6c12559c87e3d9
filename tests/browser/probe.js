// What a person would see wrong on a page: text that is too small, too faint, cut off, or on other text. Runs before the page,
// because text on a canvas can be seen only while it is drawn.
(function () {
  "use strict";
  // Text of each canvas since it was last cleared, with its box in pixels of the canvas.
  const drawn = new WeakMap();
  function on(canvas) {
    if (!drawn.has(canvas)) drawn.set(canvas, []);
    return drawn.get(canvas);
  }
  const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...rest) {
    const size = this.measureText(text);
    const corner = (across, up) => new DOMPoint(x + across, y + up).matrixTransform(this.getTransform());
    const one = corner(-size.actualBoundingBoxLeft, -size.actualBoundingBoxAscent);
    const other = corner(size.actualBoundingBoxRight, size.actualBoundingBoxDescent);
    on(this.canvas).push({
      text: String(text), colour: this.fillStyle, size: parseFloat(/([\d.]+)px/.exec(this.font)[1]),
      left: Math.min(one.x, other.x), right: Math.max(one.x, other.x), top: Math.min(one.y, other.y), bottom: Math.max(one.y, other.y),
    });
    return fillText.call(this, text, x, y, ...rest);
  };
  CanvasRenderingContext2D.prototype.clearRect = function (...area) {
    on(this.canvas).length = 0;
    return clearRect.apply(this, area);
  };

  function isSeen(element) {
    return element.checkVisibility({ visibilityProperty: true, opacityProperty: true }) && !element.closest(".spoken, script, style, title");
  }
  function ofDocument() {
    const found = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const owner = node.parentElement;
      if (!node.data.trim() || owner.closest("svg") || !isSeen(owner)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      const style = getComputedStyle(owner);
      for (const box of range.getClientRects()) {
        if (box.width < 1) continue;
        found.push({ text: node.data.trim(), owner, kind: owner.localName, size: parseFloat(style.fontSize), colour: style.color, ...sides(box) });
      }
    }
    return found;
  }
  function ofPictures() {
    return Array.from(document.querySelectorAll("svg text")).filter((text) => isSeen(text) && text.textContent.trim()).map((text) => {
      const style = getComputedStyle(text);
      const { a, b } = text.getScreenCTM();
      const scale = Math.hypot(a, b);
      return {
        text: text.textContent.trim(), owner: text, kind: "picture", size: scale * parseFloat(style.fontSize), colour: style.fill,
        ...sides(text.getBoundingClientRect()),
      };
    });
  }
  function ofCanvases() {
    return Array.from(document.querySelectorAll("canvas")).filter(isSeen).flatMap((canvas) => {
      const box = canvas.getBoundingClientRect();
      const scale = box.width / canvas.width;
      return on(canvas).map((one) => ({
        text: one.text, owner: canvas, kind: "canvas", size: scale * one.size, colour: one.colour,
        left: box.left + scale * one.left, right: box.left + scale * one.right,
        top: box.top + scale * one.top, bottom: box.top + scale * one.bottom,
      }));
    });
  }
  function sides({ left, right, top, bottom }) { return { left, right, top, bottom }; }
  function all() { return [...ofDocument(), ...ofPictures(), ...ofCanvases()]; }

  // Channels of a colour from 0 to 1, and its opacity.
  function channels(colour) {
    const paper = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    paper.fillStyle = colour;
    paper.fillRect(0, 0, 1, 1);
    return Array.from(paper.getImageData(0, 0, 1, 1).data, (value) => value / 255);
  }
  function luminance(colour) {
    const [red, green, blue] = channels(colour).map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  }
  function groundOf(element) {
    for (let at = element; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (channels(colour)[3] > 0.99) return colour;
    }
    return "white";
  }
  function contrast(one, other) {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  }

  globalThis.probe = {
    // How much text there is: where there is none, nothing was looked at.
    counts() {
      return { document: ofDocument().length, picture: ofPictures().length, canvas: ofCanvases().length };
    },
    smallerThan(least) {
      return all().filter((one) => one.size < least - 0.01).map((one) => `${one.size.toFixed(2)} px: ${one.kind} "${one.text}"`);
    },
    // Text of pictures; axe-core sees the rest.
    fainterThan(least) {
      const texts = [...ofPictures(), ...ofCanvases()];
      const known = new Map();
      return texts.map((one) => {
        const ground = groundOf(one.owner.closest("section, body"));
        const key = `${one.colour} on ${ground}`;
        if (!known.has(key)) known.set(key, contrast(one.colour, ground));
        return [known.get(key), `${known.get(key).toFixed(2)}: ${one.kind} "${one.text}", ${key}`];
      }).filter(([ratio]) => ratio < least).map(([, words]) => words);
    },
    // Pairs of texts whose boxes share more than a hair. Boxes are a little higher than letters.
    overlapping() {
      const texts = all().sort((a, b) => a.top - b.top);
      const found = [];
      texts.forEach((one, index) => {
        for (const other of texts.slice(index + 1)) {
          if (other.top > one.bottom) break;
          const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
          const down = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
          if (across > 1 && down > 3) found.push(`${one.kind} "${one.text}" and ${other.kind} "${other.text}": ${across.toFixed(0)} × ${down.toFixed(0)} px`);
        }
      });
      return found;
    },
    // Text beyond the canvas that it is drawn on, beyond the box that scrolls it, or beyond the page.
    cutOff() {
      return all().filter((one) => {
        const box = (one.kind === "canvas" ? one.owner : one.owner.closest(".wide, nav")) ?? document.documentElement;
        const { left, top } = box.getBoundingClientRect();
        const start = left - box.scrollLeft;
        const width = one.kind === "canvas" ? box.clientWidth : box.scrollWidth;
        const height = one.kind === "canvas" ? box.clientHeight : box.scrollHeight;
        return one.left < start - 1 || one.right > start + width + 1 || one.top < top - 1 || one.bottom > top + height + 1;
      }).map((one) => `${one.kind} "${one.text}"`);
    },
  };
})();
