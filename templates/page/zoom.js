// Looking closer: wheel, drag, two fingers, double click, + − 0.

import { node } from "./dom.js";

// A frame whose inside, of so many millimetres, is moved and enlarged.
export function zoomable(inside, width = 841, height = 594) {
  const frame = node("div", { class: "zoom", tabindex: 0 }, inside), at = { x: 0, y: 0, s: 1 }, fingers = new Map();
  Object.assign(inside.style, { width: `${width}px`, height: `${height}px`, transformOrigin: "0 0", position: "absolute" });
  const show = () => { inside.style.transform = `translate(${at.x}px, ${at.y}px) scale(${at.s})`; inside.style.setProperty("--s", at.s); };
  const fit = () => {
    const { clientWidth: w, clientHeight: h } = frame;
    if (!w) return;
    at.s = 0.97 * Math.min(w / width, h / height);
    at.x = (w - at.s * width) / 2; at.y = (h - at.s * height) / 2;
    at.fitted = true;
    show();
  };
  const by = (k, x = frame.clientWidth / 2, y = frame.clientHeight / 2) => {
    const s = Math.min(Math.max(at.s * k, 0.1), 40);
    at.x = x - (x - at.x) * s / at.s; at.y = y - (y - at.y) * s / at.s; at.s = s; at.fitted = false;
    show();
  };
  // A place of the sheet, mm from its lower left corner, to the middle.
  const to = (x, y, s = 4) => {
    at.s = s; at.x = frame.clientWidth / 2 - s * x; at.y = frame.clientHeight / 2 - s * (height - y); at.fitted = false;
    show();
  };
  const place = (event) => { const box = frame.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  frame.addEventListener("wheel", (event) => { event.preventDefault(); by(Math.exp(-event.deltaY / 400), ...place(event)); }, { passive: false });
  frame.addEventListener("dblclick", (event) => by(2.5, ...place(event)));
  frame.addEventListener("pointerdown", (event) => { if (event.target.closest("button, input")) return; frame.setPointerCapture(event.pointerId); fingers.set(event.pointerId, place(event)); });
  for (const kind of ["pointerup", "pointercancel"]) frame.addEventListener(kind, (event) => fingers.delete(event.pointerId));
  frame.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId), now = place(event);
    if (!before) return;
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    fingers.set(event.pointerId, now);
    if (other) {
      const size = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]);
      by(size(now) / Math.max(size(before), 1), ...other);
    } else {
      at.x += now[0] - before[0]; at.y += now[1] - before[1]; at.fitted = false;
      show();
    }
  });
  frame.addEventListener("keydown", (event) => {
    const act = { "+": () => by(1.4), "=": () => by(1.4), "-": () => by(1 / 1.4), 0: fit, ArrowLeft: () => { at.x += 60; show(); }, ArrowRight: () => { at.x -= 60; show(); },
      ArrowUp: () => { at.y += 60; show(); }, ArrowDown: () => { at.y -= 60; show(); } }[event.key];
    if (act) { event.preventDefault(); act(); }
  });
  new ResizeObserver(() => { if (at.fitted !== false) fit(); }).observe(frame);
  fit();
  return { frame, fit, by, to };
}
