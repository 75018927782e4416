// A sheet as SVG: one element for each mark of the record; millimetres, y downwards.

const CAPITAL = 0.7; // height of a capital letter in the size of the font

const fixed = (x) => String(Math.round(x * 1000) / 1000);

function arcPath([cx, cy], radius, from, to) {
  const p = (t) => `${fixed(cx + radius * Math.cos(t))} ${fixed(cy - radius * Math.sin(t))}`;
  const pieces = Math.max(Math.ceil((to - from) / 1.5), 1);
  let d = `M${p(from)}`;
  for (let i = 1; i <= pieces; i++) d += `A${fixed(radius)} ${fixed(radius)} 0 0 0 ${p(from + (to - from) * i / pieces)}`;
  return d;
}

const polyPath = (points, height, closed) => `M${points.map(([x, y]) => `${fixed(x)} ${fixed(height - y)}`).join("L")}${closed ? "z" : ""}`;

const lineOf = (g) => g.line ?? g.polyline ?? g.fill;
const roundOf = (g) => ({ from: 0, to: 2 * Math.PI, ...(g.circle ?? g.arc) });

function pathOf(g, height) {
  const { centre, radius, from, to } = roundOf(g);
  return centre ? arcPath([centre[0], height - centre[1]], radius, from, to) : polyPath(lineOf(g), height, g.closed || g.fill);
}

function look(style) {
  const { width, pattern } = record.styles[style] ?? { width: 0.2, pattern: [] };
  return `stroke-width="${width}"${pattern.length ? ` stroke-dasharray="${pattern.join(" ")}"` : ""}`;
}

// A mark as an element; where it is stands in `place`, or is set later.
function markSvg(style, g, place = "") {
  if (g.text) return `<text class="mark" font-size="${fixed(g.text.height / CAPITAL)}" ${place}>${plain(g.text.string)}</text>`;
  return g.fill ? `<path class="mark fill" ${place}/>` : `<path class="mark" ${look(style)} ${place}/>`;
}

// The attribute that says where a mark is, and what it says: letters are moved, turned and widened.
function placeOf(g, height) {
  if (!g.text) return ["d", pathOf(g, height)];
  const { at: [x, y], angle, wide = 1 } = g.text;
  return ["transform", `translate(${fixed(x)} ${fixed(height - y)})${angle ? ` rotate(${fixed(-angle * 180 / Math.PI)})` : ""}${wide === 1 ? "" : ` scale(${wide} 1)`}`];
}

const leaf = { sheet: null, elements: [], width: 0, height: 0, zoom: null };

const fit = (quick) => leaf.zoom.fit(quick, [-6, -6, leaf.width + 12, leaf.height + 12]);

// A part of the sheet, mm, y upwards, comes in sight.
function fitBox([x0, y0, x1, y1], pad = 12) {
  leaf.zoom.go([x0 - pad, leaf.height - y1 - pad, Math.max(x1 - x0, 60) + 2 * pad, Math.max(y1 - y0, 45) + 2 * pad]);
}

function drawSheet(sheet) {
  const svg = $("sheet"), [width, height] = sheet.size;
  Object.assign(leaf, { sheet, width, height, outlines: null });
  svg.innerHTML = `<title>${plain(sheet.title)}</title><rect class="leaf" width="${width}" height="${height}"/><g id="marks">`
    + sheet.marks.map(({ style, geometry }) => { const [name, text] = placeOf(geometry, height); return markSvg(style, geometry, `${name}="${text}"`); }).join("") + '</g><g id="hand"></g>';
  svg.setAttribute("aria-label", sheet.title);
  leaf.elements = [...svg.querySelectorAll("#marks > *")];
  byKeys(svg, leaf.elements, sheet.marks, askMark);
  drawMarkers(sheet);
}

const HIT = 9; // a click so near to a mark means it, pixels

// Points along a shape: a letter's middle line, enough of an arc.
function pointsAlong(g) {
  if (g.text) { const [x, y] = g.text.at, w = g.text.string.length * g.text.height * 0.6, h = g.text.height / 2; return [[x, y + h], [x + w, y + h]]; }
  const { centre, radius, from, to } = roundOf(g);
  return centre ? spread(from, to, 25).map((t) => step(centre, radius, cis(t))) : lineOf(g);
}

// Marks that come from a step, to find the one that is meant.
const outlines = (marks) => marks.flatMap((mark, n) => (mark.step ? [{ n, points: pointsAlong(mark.geometry) }] : []));

function away([x, y], [ax, ay], [bx, by]) {
  const dx = bx - ax, dy = by - ay, t = clip(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0, 1);
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

// Number of the mark nearest to a point, mm; points before lines, where both are near.
function nearest(lines, marks, p, reach) {
  let best = -1, least = reach;
  for (const { n, points } of lines) {
    let d = Infinity;
    for (let i = 0; i + 1 < points.length; i++) d = Math.min(d, away(p, points[i], points[i + 1]));
    if (["point", "text"].includes(marks[n].role)) d -= reach * 0.4;
    if (d < least) [best, least] = [n, d];
  }
  return best;
}

const pointsOf = (g) => (g.text ? [g.text.at] : lineOf(g) ?? [roundOf(g).centre]);

const boundsOf = (marks) => extentOf(marks.flatMap(({ geometry: g }) => {
  const pad = roundOf(g).radius ?? g.text?.height ?? 0;
  return pointsOf(g).flatMap(([x, y]) => [[x - pad, y - pad], [x + pad, y + pad]]);
}));

const extentOf = (points) => points.reduce((box, [x, y]) => (Number.isFinite(x + y) ? [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)] : box),
  [Infinity, Infinity, -Infinity, -Infinity]);
