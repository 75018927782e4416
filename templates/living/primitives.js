// The moves of compass and ruler, one function each, by their names in the record. A point or a direction is [x, y].
// NaN where the construction does not exist. Why the forms are these is told beside those of Python, construction/arithmetic.py.

const NOWHERE = /** @type {Z} */ ([NaN, NaN]);
const SPLIT = 134217729;

const add = /** @type {OfTwo} */ ((a, b) => [a[0] + b[0], a[1] + b[1]]);
const sub = /** @type {OfTwo} */ ((a, b) => [a[0] - b[0], a[1] - b[1]]);
const mul = /** @type {OfTwo} */ ((a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]);
const conj = /** @type {OfOne} */ ((a) => [a[0], -a[1]]);
const scale = /** @type {(s: number, a: number[]) => Z} */ ((s, a) => [s * a[0], s * a[1]]);
const size = (a) => Math.hypot(a[0], a[1]);
const cis = /** @type {(t: number) => Z} */ ((t) => [Math.cos(t), Math.sin(t)]);
const plainCross = (u, v) => u[0] * v[1] - u[1] * v[0];
const plainDot = (u, v) => u[0] * v[0] + u[1] * v[1];
const step = /** @type {(p: number[], t: number, u: number[]) => Z} */ ((p, t, u) => [p[0] + t * u[0], p[1] + t * u[1]]);
const mod = (x, y) => { const r = x % y; return r !== 0 && (r < 0) !== (y < 0) ? r + y : r; };
const clip = (x, low, high) => (x < low ? low : x > high ? high : x);

function twoProduct(a, b) {
  const p = a * b, ca = SPLIT * a, cb = SPLIT * b;
  const ah = ca - (ca - a), bh = cb - (cb - b), al = a - ah, bl = b - bh;
  return [p, al * bl - (((p - ah * bh) - al * bh) - ah * bl)];
}

function differenceOfProducts(a, b, c, d) {
  const [p, e] = twoProduct(a, b), [q, f] = twoProduct(c, d);
  return (p - q) + (e - f);
}

const cross = (u, v) => differenceOfProducts(u[0], v[1], u[1], v[0]);
const dot = (u, v) => differenceOfProducts(u[0], v[0], -u[1], v[1]);

// q - p and what rounding takes from it.
function difference(q, p) {
  const [x, y] = [0, 1].map((i) => twoSum(q[i], -p[i]));
  return [[x[0], y[0]], [x[1], y[1]]];
}

function unit(angle) {
  const quarter = angle / (Math.PI / 2);
  if (quarter === Math.round(quarter)) return [[1, 0], [0, 1], [-1, 0], [0, -1]][mod(quarter, 4)];
  return cis(angle);
}

function halfChord(d, r1, r2) {
  if (Number.isNaN(d + r1 + r2)) return NaN;
  const [c, b, a] = [r1, r2, d].sort((x, y) => x - y);
  return Math.sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))) / (2 * d);
}

// --- taken from the crank angle: digits.js ---------------------------------------------------------------------------------

function tangentLength(phi, l1, ahead, pivot, fixed, radius) {
  const gap = gapOfArcs([l1, ahead, pivot, fixed], radius);
  return gap === null ? NaN : Math.sqrt(-gap.at(phi));
}

// --- a triangle on three legs --------------------------------------------------------------------------------------------

const CIRCLE = 0, LINE = 1, SLOT = 2;
const FAR = 0.05, MOVES = 6;

function conditions(k, u, legs) {
  return [0, 5, 10].map((i) => {
    const [does, p, d, length, corner] = legs.slice(i, i + 5), at = add(k, mul(corner, u));
    if (does === CIRCLE) {
      const r = sub(at, p), far = size(r);
      return { f: far - length, n: [r[0] / far, r[1] / far], at };
    }
    const n = does === LINE ? [-d[1], d[0]] : mul(mul([0, 1], u), cis(length));
    return { f: plainDot(n, sub(at, p)), n, at: does === LINE ? at : p };
  });
}

const momentAbout = (k, { n, at }) => plainCross(sub(at, k), n);

const coefficients = (k, all) => [all.map((c) => c.n[0]), all.map((c) => c.n[1]), all.map((c) => momentAbout(k, c))];

const determinantOf = (/** @type {any[]} */ [x, y, m]) => m[0] * (x[1] * y[2] - x[2] * y[1]) - m[1] * (x[0] * y[2] - x[2] * y[0]) + m[2] * (x[0] * y[1] - x[1] * y[0]);

function correction(k, u, legs) {
  const all = conditions(k, u, legs), [x, y, m] = coefficients(k, all), det = determinantOf([x, y, m]);
  const by = ([a, b]) => -[[1, 2], [2, 0], [0, 1]].reduce((sum, [i, j], n) => sum + (a[i] * b[j] - a[j] * b[i]) * all[n].f, 0)
    / (det === 0 ? NaN : det);
  return /** @type {[Z, number]} */ ([[by([y, m]), by([m, x])], by([x, y])]);
}

function extent(legs) {
  const each = [0, 5, 10].map((i) => size(legs[i + 4]) + (legs[i] === CIRCLE ? Math.abs(legs[i + 3]) : 0));
  return each[0] + each[1] + each[2] + Math.max(...[1, 6, 11].map((i) => size(legs[i])));
}

const straight = /** @type {OfOne} */ ((u) => { const d = size(u); return [u[0] / d, u[1] / d]; });

function solved(k, u, legs) {
  u = straight(u);
  const whole = extent(legs), [start, turned] = [k, u];
  for (let i = 0; i < 40; i++) {
    const [dk, turn] = correction(k, u, legs);
    k = add(k, dk);
    u = straight(mul(u, cis(turn)));
    if (!(size(dk) + Math.abs(turn) * whole > 4e-16 * whole)) break;
  }
  const missed = Math.max(...conditions(k, u, legs).map((c) => Math.abs(c.f)));
  const lost = !(missed < 1e-11 * whole) || size(sub(k, start)) + whole * size(sub(u, turned)) > FAR * whole;
  return lost ? [NOWHERE, NOWHERE] : [k, u];
}

function freely(k, u, legs, way, corner) {
  const [a, b] = conditions(k, u, legs), ma = momentAbout(k, a), mb = momentAbout(k, b);
  const dk = [a.n[1] * mb - b.n[1] * ma, ma * b.n[0] - a.n[0] * mb], turn = a.n[0] * b.n[1] - a.n[1] * b.n[0];
  const moved = size(add(dk, scale(turn, mul([0, 1], mul(corner, u)))));
  const s = way / Math.max(moved, 0.2 * (size(dk) + Math.abs(size(corner) * turn)));
  return [step(k, s, dk), mul(u, cis(s * turn))];
}

function back(k, u, legs) {
  const both = conditions(k, u, legs).slice(0, 2), whole = Math.max(size(legs[4]), size(legs[9]), size(legs[14]));
  const [p, q] = both.map((c) => [c.n[0], c.n[1], momentAbout(k, c) / whole]);
  const inner = (v, w) => v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  const a = inner(p, p), b = inner(p, q), c = inner(q, q), det = a * c - b * b;
  const first = (c * both[0].f - b * both[1].f) / det, second = (a * both[1].f - b * both[0].f) / det;
  const [dx, dy, turn] = [0, 1, 2].map((i) => -(p[i] * first + q[i] * second));
  return [add(k, [dx, dy]), mul(u, cis(turn / whole))];
}

function moved(k, u, amount, legs) {
  for (let i = 0; i < MOVES; i++) {
    [k, u] = freely(k, u, legs, amount / MOVES, legs[14]);
    for (let n = 0; n < 3; n++) [k, u] = back(k, u, legs);
  }
  return [k, u];
}

// Points among the numbers of legs that are told as one real number.
const pointed = (legs) => legs.map((x, i) => (typeof x === "number" && [1, 2, 4].includes(i % 5) ? [x, 0] : x));

// How many of some ascending numbers are not greater than x, or less than x.
const upTo = (numbers, x) => { let n = 0; while (n < numbers.length && numbers[n] <= x) n++; return n; };
const before = (numbers, x) => { let n = 0; while (n < numbers.length && numbers[n] < x) n++; return n; };

function onCourse(phi, angles, values) {
  if (Number.isNaN(phi)) return NOWHERE;
  const x = angles[0] + mod(phi - angles[0], 2 * Math.PI);
  const i = clip(upTo(angles, x) - 1, 0, angles.length - 2), share = (x - angles[i]) / (angles[i + 1] - angles[i]);
  const a = values[i], b = values[i + 1];
  if (Number.isNaN(a[0])) return share > 0.5 ? b : NOWHERE;
  if (Number.isNaN(b[0])) return share <= 0.5 ? a : NOWHERE;
  return step(a, share, sub(b, a));
}

// --- loads -------------------------------------------------------------------------------------------------------------------

const NEAR = 1e-12;

function read(curve, t, side, period) {
  const { x, y, left, right, law } = curve, last = x[x.length - 1];
  if (period) {
    t = mod(t - x[0], period) + x[0];
    if (side < 0) t = t - x[0] < NEAR ? last : t;
    else t = last - t < NEAR ? x[0] : t;
  }
  if (Number.isNaN(t)) return NaN;
  for (let i = 0; i + 1 < x.length; i++) if (x[i] === x[i + 1] && Math.abs(t - x[i]) < NEAR) t = x[i];
  if (side >= 0 ? t >= last : t > last) return y[y.length - 1];
  if (side >= 0 ? t < x[0] : t <= x[0]) return y[0];
  const k = clip((side < 0 ? before(x, t) : upTo(x, t)) - 1, 0, x.length - 2), h = x[k + 1] - x[k];
  const s = clip((t - x[k]) / (h > 0 ? h : 1), 0, 1), r = 1 - s;
  return law === "straight" ? y[k] + s * (y[k + 1] - y[k]) : r * r * (y[k] * (1 + 2 * s) + h * s * left[k]) + s * s * (y[k + 1] * (1 + 2 * r) - h * r * right[k]);
}

function swung(u, sense, low, swing) {
  const spare = Math.PI - swing / 2, turn = mod(sense * Math.atan2(u[1], u[0]) - low + spare, 2 * Math.PI);
  return clip((turn - spare) / swing, 0, 1);
}

// Each by its name; those that have one in this file, too, are used elsewhere.
const PRIMITIVES = {
  "difference of products": differenceOfProducts,
  cross, dot, unit,
  "lines meet"(p, u, q, v, det, way) {
    if (way !== undefined && !Number.isNaN(way)) return step(p, way, u);
    const [w, lost] = difference(q, p);
    const turned = det === undefined || Number.isNaN(det) ? cross(u, v) : det;
    if (Math.abs(plainCross(w, v)) > Math.abs(plainCross(w, u))) [p, u, v] = [q, v, u];
    const t = turned === 0 ? NaN : (cross(w, v) + plainCross(lost, v)) / turned;
    return step(p, t, u);
  },
  "arc cuts arc"(c1, r1, c2, r2, side, height, distance, line) {
    if (line !== undefined) return add(c1, mul([distance / 2, side * height], line));
    const e = sub(c2, c1);
    let d = size(e);
    const u = [e[0] / d, e[1] / d];
    if (height === undefined) height = halfChord(d, r1, r2);
    if (distance !== undefined) d = distance;
    const foot = (d + (r1 - r2) * (r1 + r2) / d) / 2;
    return add(c1, mul([foot, side * height], u));
  },
  "arc cuts line"(centre, radius, p, u, side, half) {
    const [w, lost] = difference(p, centre);
    const height = cross(u, w) + plainCross(u, lost);
    if (half === undefined) half = Math.sqrt((radius - height) * (radius + height));
    const along = side * half - (dot(u, w) + plainDot(u, lost));
    return Math.abs(along) <= radius ? step(p, along, u) : add(centre, mul([side * half, height], u));
  },
  tangent(p, centre, radius, side) {
    const e = sub(p, centre), d = size(e), cos = radius / d, sin = Math.sqrt((d - radius) * (d + radius)) / d;
    return add(centre, scale(radius / d, mul([cos, -side * sin], e)));
  },
  "tangent direction"(p, centre, radius, side, length, distance) {
    const e = sub(p, centre), d = size(e);
    if (length === undefined || distance === undefined) [length, distance] = [Math.sqrt((d - radius) * (d + radius)), d];
    return mul([length / distance, side * radius / distance], [e[0] / d, e[1] / d]);
  },
  "distance from the crank's point": (...span) => tangentLength(...span, 0),
  "tangent from the crank's point": tangentLength,
  "half-chord of two arcs"(phi, l1, ahead, pivot, fixed, l2, l3) {
    const span = [l1, ahead, pivot, fixed], gaps = gapsOfArcs(span, l2, l3);
    if (gaps === null) return NaN;
    const [p, q] = gaps;
    if (q.touches && Math.abs(l2 - l3) <= 1e-15 * (l2 + l3 + size(pivot) + size(fixed))) return Math.abs(p.root(phi)) / 2;
    if (p.touches || q.touches) return Math.abs(p.root(phi) * q.root(phi)) / tangentLength(phi, ...span, 0) / 2;
    return Math.sqrt(gapOfArcs(span, l2, l3).at(phi) * gapOfArcs(span, l2, -l3).at(phi) / gapOfArcs(span, 0).at(phi)) / 2;
  },
  "half-chord of arc and line"(phi, l1, ahead, length, pivot, through, guide) {
    const gaps = gapsOfLine(l1, ahead, length, pivot, through, guide);
    if (gaps === null) return NaN;
    const [p, q] = gaps;
    return p.touches || q.touches ? Math.abs(p.root(phi) * q.root(phi)) : Math.sqrt(p.at(phi) * q.at(phi));
  },
  "foot on a guide"(at, through, guide) {
    if (![...at, ...through, guide].every(Number.isFinite)) return NOWHERE;
    const [above, cos, sin] = height(at, through, guide);
    return [few(many(at[0]) + times(above, sin)), few(many(at[1]) - times(above, cos))];
  },
  "corner of a triangle on three legs"(k, u, ...numbers) {
    const legs = pointed(numbers), [first, along] = solved(k, u, legs);
    return add(first, mul(along, legs[14]));
  },
  "direction of a triangle on three legs": (k, u, ...legs) => solved(k, u, pointed(legs))[1],
  "value on a followed course": onCourse,
  "false position": (k, u, amount, ...legs) => moved(k, u, amount, pointed(legs))[0],
  "side of a false position"(k, u, amount, ...numbers) {
    const legs = pointed(numbers);
    [k, u] = moved(k, u, amount, legs);
    const [does, p, d, length, corner] = legs.slice(5, 10);
    if (does === CIRCLE) return plainCross(sub(p, k), mul(corner, u)) >= 0 ? 1 : -1;
    if (does === LINE) return plainDot(d, mul(corner, u)) >= 0 ? 1 : -1;
    return plainDot(sub(p, k), mul(u, cis(length))) >= 0 ? 1 : -1;
  },
  "fraction of a swing": swung,
  "ordinate of a diagram": (curve, at, ahead) => read(curve, at, ahead < 0 ? -1 : 1, 0),
  "ordinate of a periodic diagram": (curve, at, turns, side) => read(curve, at, Math.trunc(side), 2 * Math.PI * turns),
  "value or its limit": (value, limit) => (Number.isNaN(limit) ? value : limit),
  "round to a step": (x, by) => (Number.isFinite(x / by) ? Number((Math.floor(x / by + 0.5) * by).toPrecision(12)) : NaN),
  "15 digits": (x) => Number(x.toPrecision(15)),
};
