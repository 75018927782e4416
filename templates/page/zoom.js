// Looking closer at a drawing: wheel, drag, two fingers, buttons. What is seen is a box of it, in its units, y downwards.

import { animate, button, node, say, still } from "./dom.js";

const CLOSEST = 12, WIDEST = 3, FURTHER = 4 / 3; // of what is seen: units, and times the whole; how much a button enlarges

// `show` is given the box and how many units a pixel is; `click` where it was, and the same.
export function zoomable(frame, show, click = /** @type {(...told: any[]) => void} */ (() => {})) {
  const box = { x: 0, y: 0, w: 1, h: 1 }, fingers = new Map(), state = { whole: [0, 0, 1, 1], fitted: true, travelled: 0 };
  const pixel = () => { const { width, height } = frame.getBoundingClientRect(); return Math.max(box.w / width, box.h / height); };
  const place = ({ clientX, clientY }) => {
    const { left, top, width, height } = frame.getBoundingClientRect(), s = pixel();
    return [box.x + box.w / 2 + (clientX - left - width / 2) * s, box.y + box.h / 2 + (clientY - top - height / 2) * s];
  };
  const go = (to, quick = still()) => {
    const from = [box.x, box.y, box.w, box.h];
    state.fitted = to === state.whole;
    animate(box, quick ? 0 : 450, (t) => {
      const [x, y, w, h] = from.map((start, n) => start + (to[n] - start) * (1 - (1 - t) ** 3));
      Object.assign(box, { x, y, w, h });
      if (Number.isFinite(pixel())) show(box, pixel());
    });
  };
  const by = (times, [x, y] = /** @type {number[]} */ ([box.x + box.w / 2, box.y + box.h / 2])) => {
    const s = Math.min(Math.max(box.w / times, CLOSEST), WIDEST * state.whole[2]) / box.w;
    go([x + (box.x - x) * s, y + (box.y - y) * s, box.w * s, box.h * s], true);
  };
  const move = (x, y) => go([box.x + x * pixel(), box.y + y * pixel(), box.w, box.h], true);
  const fit = (quick, whole = state.whole) => { state.whole = whole; go(whole, quick); };
  frame.addEventListener("wheel", (event) => {
    event.preventDefault();
    by(Math.exp(-Math.min(Math.max(event.deltaY, -120), 120) * 0.0022), place(event));
  }, { passive: false });
  frame.addEventListener("pointerdown", (event) => {
    if (event.target.closest("button, input")) return;
    frame.setPointerCapture(event.pointerId);
    if (!fingers.size) state.travelled = 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  frame.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId), now = [event.clientX, event.clientY];
    if (!last) return;
    state.travelled += Math.abs(now[0] - last[0]) + Math.abs(now[1] - last[1]);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1], gap = (z) => Math.hypot(z[0] - other[0], z[1] - other[1]);
    if (other) by(gap(now) / Math.max(gap(last), 1), place(event));
    move((last[0] - now[0]) / fingers.size, (last[1] - now[1]) / fingers.size);
    fingers.set(event.pointerId, now);
  });
  for (const kind of ["pointerup", "pointercancel"]) frame.addEventListener(kind, (event) => {
    if (fingers.delete(event.pointerId) && state.travelled < 6 && kind === "pointerup") click(place(event), pixel());
  });
  new ResizeObserver(() => go(state.fitted ? state.whole : [box.x, box.y, box.w, box.h], true)).observe(frame);
  const tools = [["+", "zoom in", () => by(FURTHER)], ["−", "zoom out", () => by(1 / FURTHER)], ["⤢", "whole sheet", () => fit()]].map(
    ([sign, key, act]) => button(sign, act, { "aria-label": say(key), title: say(key) }));
  return { go, by, move, fit, tools };
}

// A frame in which a leaf, of so many millimetres, is moved and enlarged.
export function framed(inside, width = 841, height = 594) {
  const frame = node("div", { class: "zoom", tabindex: 0 }, inside);
  Object.assign(inside.style, { width: `${width}px`, height: `${height}px`, transformOrigin: "0 0", position: "absolute" });
  const zoom = zoomable(frame, ({ x, y, w, h }, pixel) => {
    const [left, top] = [frame.clientWidth / 2 - (x + w / 2) / pixel, frame.clientHeight / 2 - (y + h / 2) / pixel];
    inside.style.transform = `translate(${left}px, ${top}px) scale(${1 / pixel})`;
    inside.style.setProperty("--s", 1 / pixel);
  });
  frame.addEventListener("keydown", (event) => {
    const act = { "+": () => zoom.by(FURTHER), "=": () => zoom.by(FURTHER), "-": () => zoom.by(1 / FURTHER), 0: () => zoom.fit(),
      ArrowLeft: () => zoom.move(-60, 0), ArrowRight: () => zoom.move(60, 0), ArrowUp: () => zoom.move(0, -60), ArrowDown: () => zoom.move(0, 60) }[event.key];
    if (act) { event.preventDefault(); act(); }
  });
  zoom.fit(true, [-0.015 * width, -0.015 * height, 1.03 * width, 1.03 * height]);
  const to = (x, y) => zoom.go([x - width / 8, height - y - height / 8, width / 4, height / 4]); // a place of the sheet, mm from its lower left corner
  return { ...zoom, frame, to };
}
