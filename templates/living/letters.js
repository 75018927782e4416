// Lettering of a card: in motion what would lie on others for much of the turn is left out, in a lesson each stands where it covers least.

const MOMENTS = 24, CROWDED = 0.2, SIGN = 0.6, NAMED = [8, 6]; // the width of a sign beside its height, room of a letter with its index, mm
const AROUND = [1, 2.4, 4, 6], ALONG = [0, -0.1, 0.1, -0.22, 0.22], CLEAR = 0.7; // gaps at a point, mm; other shares of a vector; air around letters, mm
const COVERED = { box: 5, line: 1.5, outside: 20 }; // how bad it is to cover a letter, a line, to stand beyond the card

// Letterings of some marks as numbers of their signs; short ones, which are those of points, come first.
function letteringsOf(marks) {
  const found = new Map();
  marks.forEach((mark, n) => { if (mark.role === "text" && mark.at && mark.lettering) found.set(mark.lettering, [...(found.get(mark.lettering) ?? []), n]); });
  return [...found.values()].sort((a, b) => a.length - b.length);
}

const boxOf = (card, signs, placed) => extentOf(signs.flatMap((n) => {
  const mark = card.marks[n], g = geometryOf(mark, placed), [x, y] = g.text?.at ?? [];
  return g.text ? [[x, y], [x + SIGN * mark.height * mark.string.length, y + mark.height]] : pointsOf(g);
}));

const areApart = (a, b) => a[0] > b[2] || b[0] > a[2] || a[1] > b[3] || b[1] > a[3];

// Letters of a plan that would lie on others for much of the turn are left out, each with all of its signs.
function chooseLetters(card, turn) {
  const many = Math.min(turn.length, MOMENTS), moments = Array.from({ length: many }, (_, i) => placer(turn[Math.floor(i * turn.length / many)], card.shrunk)), kept = [];
  card.left = new Set();
  for (const signs of card.letterings) {
    const boxes = moments.map((placed) => boxOf(card, signs, placed)), covered = boxes.filter((box, i) => kept.some((other) => !areApart(box, other[i]))).length;
    if (covered > CROWDED * many) signs.forEach((n) => card.left.add(n)); else kept.push(boxes);
  }
  card.elements.forEach((element, n) => element.toggleAttribute("hidden", card.left.has(n)));
}

// How much of a segment is inside a box, mm.
function inside(box, a, b) {
  let [low, high] = [0, 1];
  for (const i of [0, 1]) {
    const d = b[i] - a[i] || 1e-9, ends = [(box[i] - a[i]) / d, (box[i + 2] - a[i]) / d];
    low = Math.max(low, Math.min(...ends));
    high = Math.min(high, Math.max(...ends));
  }
  return high > low ? (high - low) * size(sub(b, a)) : 0;
}

const boxAt = (/** @type {any[]} */ [x, y], /** @type {any[]} */ [w, h], more = 0) => [x - w / 2 - more, y - h / 2 - more, x + w / 2 + more, y + h / 2 + more];

// The place, of some with their costs, at which a box of a size covers least of lines and boxes; beyond the view it is of no use.
function leastCovered(places, wide, { lines, boxes, view }) {
  let best = null;
  for (const [at, own] of places) {
    const box = boxAt(at, wide, CLEAR);
    let cost = own + COVERED.outside * Number(box[0] < view[0] || box[1] < view[1] || box[2] > view[2] || box[3] > view[3]);
    for (const other of boxes) if (cost < best?.cost || !best) cost += areApart(box, other) ? 0 : COVERED.box;
    for (const [a, b] of lines) if (cost < best?.cost || !best) { const long = inside(box, a, b); cost += long && COVERED.line + long / 5; }
    if (!best || cost < best.cost) best = { cost, at };
  }
  return best.at;
}

// What lettering in a card is not to cover: what is drawn of it now, or all of its marks. The line of the caption is no part of its view.
function obstaclesOf(card, placed, now = true) {
  const drawn = (n) => !now || !card.elements[n].matches(".undrawn");
  const { x, y, width, height } = card.svg.viewBox.baseVal, view = [x, -y - height, x + width, -y - 26 * pixelOf(card.svg)];
  const outlines = card.marks.filter((mark, n) => mark.role !== "text" && drawn(n)).map((mark) => pointsAlong(geometryOf(mark, placed)));
  const lines = outlines.flatMap((points) => points.slice(1).map((b, n) => [points[n], b])).filter((pair) => pair.flat().every(Number.isFinite));
  return { lines, boxes: (now ? card.letterings : []).filter(([n]) => drawn(n)).map((signs) => boxOf(card, signs, placed)), view };
}

const AWAY = Array.from({ length: 16 }, (_, n) => cis(n * Math.PI / 8));

// Places for a box of a size around a point, and beside a vector.
const placesAround = (a, /** @type {any[]} */ [w, h]) => AROUND.flatMap((gap) => AWAY.map(([x, y]) => [add(a, [x * (w / 2 + gap), y * (h / 2 + gap)]), gap / 8]));

function placesBeside(a, b, share, /** @type {any[]} */ [w, h]) {
  const [x, y] = across(straight(sub(b, a)));
  return ALONG.flatMap((more, n) => [1, -1, 1.5, -1.5].map((side) => [add(step(a, clip(share + more, 0.1, 0.9), sub(b, a)), scale(side * (Math.abs(x) * w / 2 + Math.abs(y) * h / 2 + 1.2), [x, y])), n / 4 + Math.abs(side) / 2]));
}

// Letters around their points and beside their vectors, anew when the mechanism or the view is another.
function placeLetters(card, placed, values) {
  if (card.lettered?.[0] === values && card.lettered[1] === card.svg.box) return;
  card.lettered = [values, card.svg.box];
  card.shifts.clear();
  const known = obstaclesOf(card, placed, false);
  for (const signs of card.letterings) {
    const mark = card.marks[signs[0]], [x0, y0, x1, y1] = boxOf(card, signs, placed), wide = [x1 - x0, y1 - y0], [id, , , other, share] = mark.at[0];
    const own = card.sources[signs[0]]?.step, named = signs.map((n) => card.marks[n].string ?? "").join("").split(",")[0] === stepOf(own)?.name && own in record.motion.all.results;
    const a = placed.point(mark, id), b = other ? placed.point(mark, other) : a, end = named ? placed.point(mark, own) : !other || size(sub(b, a)) < 2 ? a : null;
    if (![...a, ...b].every(Number.isFinite)) continue;
    const middle = [(x0 + x1) / 2, (y0 + y1) / 2], hung = mark.along.length === 1 && !other && stepOf(mark.along[0]).kind; // on a force, which it stays beside, or a block
    const at = leastCovered(hung === "force" ? [[middle, 0], ...placesAround(middle, [2, 2])] : hung ? placesAround(a, add(wide, [8, 8])) : end ? placesAround(end, wide) : placesBeside(a, b, share, wide), wide, known);
    card.shifts.set(mark.lettering, sub(at, middle));
    known.boxes.push(boxAt(at, wide));
  }
}
