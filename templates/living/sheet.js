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

function pathOf(g, height) {
  if (g.line) return polyPath(g.line, height);
  if (g.polyline) return polyPath(g.polyline, height, g.closed);
  if (g.fill) return polyPath(g.fill, height, true);
  if (g.circle) return arcPath([g.circle.centre[0], height - g.circle.centre[1]], g.circle.radius, 0, 2 * Math.PI);
  return arcPath([g.arc.centre[0], height - g.arc.centre[1]], g.arc.radius, g.arc.from, g.arc.to);
}

function look(style) {
  const { width, pattern } = record.styles[style] ?? { width: 0.2, pattern: [] };
  return `stroke-width="${width}"${pattern.length ? ` stroke-dasharray="${pattern.join(" ")}"` : ""}`;
}

function markText(x, y, height, angle, string, wide = 1) {
  const turned = wide !== 1 ? ` transform="translate(${fixed(x)} ${fixed(y)}) rotate(${fixed(-angle * 180 / Math.PI)}) scale(${wide} 1) translate(${fixed(-x)} ${fixed(-y)})"` :
    angle ? ` transform="rotate(${fixed(-angle * 180 / Math.PI)} ${fixed(x)} ${fixed(y)})"` : "";
  return `x="${fixed(x)}" y="${fixed(y)}" font-size="${fixed(height / CAPITAL)}"${turned}>${plain(string)}`;
}

function markSvg(mark, n, height) {
  const g = mark.geometry;
  if (g.text) return `<text class="mark" data-n="${n}" ${markText(g.text.at[0], height - g.text.at[1], g.text.height, g.text.angle, g.text.string, g.text.wide)}</text>`;
  if (g.fill) return `<path class="mark fill" data-n="${n}" d="${pathOf(g, height)}"/>`;
  return `<path class="mark" data-n="${n}" ${look(mark.style)} d="${pathOf(g, height)}"/>`;
}

const leaf = { sheet: null, elements: [], width: 0, height: 0, zoom: null };

const fit = (quick) => leaf.zoom.fit(quick, [-6, -6, leaf.width + 12, leaf.height + 12]);

// A part of the sheet, mm, y upwards, comes in sight.
function fitBox([x0, y0, x1, y1], pad = 12) {
  leaf.zoom.go([x0 - pad, leaf.height - y1 - pad, Math.max(x1 - x0, 60) + 2 * pad, Math.max(y1 - y0, 45) + 2 * pad]);
}

function drawSheet(sheet) {
  const svg = $("sheet"), [width, height] = sheet.size;
  Object.assign(leaf, { sheet, width, height });
  svg.innerHTML = `<title>${plain(sheet.title)}</title><rect class="leaf" width="${width}" height="${height}"/><g id="marks">`
    + sheet.marks.map((mark, n) => markSvg(mark, n, height)).join("") + '</g><g id="hand"></g>';
  svg.setAttribute("aria-label", sheet.title);
  leaf.elements = [...svg.querySelectorAll("#marks > *")];
  leaf.outlines = null;
  drawMarkers(sheet);
}

const HIT = 9; // a click so near to a mark means it, pixels

// Points along each mark that comes from a step, to find the one that is meant.
function outlines(marks) {
  return marks.flatMap((mark, n) => {
    if (!mark.step) return [];
    const g = mark.geometry;
    if (g.text) {
      const [x, y] = g.text.at, w = g.text.string.length * g.text.height * 0.6, h = g.text.height;
      return [{ n, points: [[x, y + h / 2], [x + w, y + h / 2]] }];
    }
    const round = g.circle ?? g.arc;
    if (!round) return [{ n, points: g.line ?? g.polyline ?? g.fill }];
    const [from, to] = g.circle ? [0, 2 * Math.PI] : [g.arc.from, g.arc.to], many = 24;
    return [{ n, points: Array.from({ length: many + 1 }, (_, i) => {
      const t = from + (to - from) * i / many;
      return [round.centre[0] + round.radius * Math.cos(t), round.centre[1] + round.radius * Math.sin(t)];
    }) }];
  });
}

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

const pointsOf = (g) => (g.text ? [g.text.at] : g.circle || g.arc ? [(g.circle ?? g.arc).centre] : g.line ?? g.polyline ?? g.fill);

const boundsOf = (marks) => extentOf(marks.flatMap(({ geometry: g }) => {
  const pad = (g.circle ?? g.arc)?.radius ?? g.text?.height ?? 0;
  return pointsOf(g).flatMap(([x, y]) => [[x - pad, y - pad], [x + pad, y + pad]]);
}));

function extentOf(points) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    if (Number.isFinite(x) && Number.isFinite(y)) {
      box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y); box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
    }
  }
  return box;
}
