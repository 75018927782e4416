// Pan and zoom: the part of the sheet that is seen; wheel, drag, two fingers, keys.

const view = { x: 0, y: 0, w: 841, h: 594, moving: 0 };

function show() { $("sheet").setAttribute("viewBox", `${view.x} ${view.y} ${view.w} ${view.h}`); }

// Millimetres of the sheet, y upwards, of a point of the window; and of one pixel.
function onSheet(event) {
  const box = $("sheet").getBoundingClientRect(), s = Math.max(view.w / box.width, view.h / box.height);
  const x = view.x + view.w / 2 + (event.clientX - box.left - box.width / 2) * s;
  const y = view.y + view.h / 2 + (event.clientY - box.top - box.height / 2) * s;
  return { p: [x, leaf.height - y], pixel: s };
}

function go(x, y, w, h, quick = still()) {
  cancelAnimationFrame(view.moving);
  if (quick) { Object.assign(view, { x, y, w, h }); show(); return; }
  const from = { ...view }, start = performance.now();
  const frame = (now) => {
    const t = clip((now - start) / 450, 0, 1), e = 1 - (1 - t) ** 3;
    Object.assign(view, { x: from.x + (x - from.x) * e, y: from.y + (y - from.y) * e, w: from.w + (w - from.w) * e, h: from.h + (h - from.h) * e });
    show();
    if (t < 1) view.moving = requestAnimationFrame(frame);
  };
  view.moving = requestAnimationFrame(frame);
}

const fit = (quick) => go(-6, -6, leaf.width + 12, leaf.height + 12, quick);

function fitBox([x0, y0, x1, y1], pad = 12) {
  go(x0 - pad, leaf.height - y1 - pad, Math.max(x1 - x0, 60) + 2 * pad, Math.max(y1 - y0, 45) + 2 * pad);
}

function zoom(by, at = [view.x + view.w / 2, view.y + view.h / 2]) {
  const w = clip(view.w * by, 12, 2600), s = w / view.w;
  go(at[0] + (view.x - at[0]) * s, at[1] + (view.y - at[1]) * s, w, view.h * s, true);
}

function watchViewport(click) {
  const svg = $("sheet"), fingers = new Map();
  let travelled = 0;
  svg.addEventListener("wheel", (event) => {
    event.preventDefault();
    const { p } = onSheet(event);
    zoom(Math.exp(clip(event.deltaY, -120, 120) * 0.0022), [p[0], leaf.height - p[1]]);
  }, { passive: false });
  svg.addEventListener("pointerdown", (event) => {
    svg.setPointerCapture(event.pointerId);
    if (!fingers.size) travelled = 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  svg.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const { p, pixel } = onSheet(event), dx = event.clientX - last[0], dy = event.clientY - last[1];
    travelled += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
      const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, z]) => z);
      const gap = (z) => Math.hypot(z[0] - other[0], z[1] - other[1]);
      zoom(gap(last) / (gap([event.clientX, event.clientY]) || 1), [p[0], leaf.height - p[1]]);
    }
    go(view.x - dx * pixel / fingers.size, view.y - dy * pixel / fingers.size, view.w, view.h, true);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  const up = (event) => {
    if (fingers.delete(event.pointerId) && travelled < 6 && event.type === "pointerup") click(onSheet(event));
  };
  svg.addEventListener("pointerup", up);
  svg.addEventListener("pointercancel", up);
  $("zoom").append(...[["+", "zoom in", () => zoom(0.75)], ["−", "zoom out", () => zoom(1 / 0.75)], ["⤢", "whole sheet", () => fit()]].map(
    ([sign, key, act]) => node("button", { type: "button", "aria-label": say(key), title: say(key), onclick: act }, sign)));
}
