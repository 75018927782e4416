// Numbers of many digits, and quantities a + b cos(x) that vanish at a limit angle of the crank without loss of digits there.
// A number is a BigInt in units of 2^-280; what it is good for is told in construction/limit_angles.py.

const BITS = 280n, ONE = 1n << BITS;

function many(x) {
  let shift = 0;
  while (!Number.isInteger(x)) { x *= 2; shift++; }
  return shift > 280 ? BigInt(x) >> BigInt(shift - 280) : BigInt(x) << BigInt(280 - shift);
}

const few = (x) => Number(x) * 2 ** -280;
const times = /** @type {Large} */ ((x, y) => (x * y) >> BITS);
const over = (x, y) => (x << BITS) / y;
const magnitude = (x) => (x < 0n ? -x : x);
const split = (x) => { const high = few(x); return [high, few(x - many(high))]; };

function root(x) {
  if (x <= 0n) return 0n;
  const square = x << BITS;
  let y = 1n << BigInt((square.toString(2).length + 1) >> 1);
  for (;;) {
    const next = (y + square / y) >> 1n;
    if (next >= y) return y;
    y = next;
  }
}

const PI = (314159265358979323846264338327950288419716939937510582097494459230781640628621n << BITS) / 10n ** 77n;
const SAME = (x) => x / 10n ** 50n;
const MEANT = many(1e-15);

function cosSin(x) {
  const y = x >> 12n;
  let term = y, versine = 0n, sin = y;
  for (let n = 2n; magnitude(term) > 1n; n++) {
    term = times(term, y) / n;
    if (n % 2n) sin += n % 4n === 1n ? term : -term;
    else versine += n % 4n === 2n ? term : -term;
  }
  for (let i = 0; i < 12; i++) [versine, sin] = [2n * times(sin, sin), 2n * times(sin, ONE - versine)];
  return [ONE - versine, sin];
}

function angleOf(x, y) {
  if (!x && !y) return 0n;
  const length = root(times(x, x) + times(y, y));
  let angle = many(Math.atan2(few(over(y, length)), few(over(x, length))));
  for (let i = 0; i < 2; i++) {
    const [cos, sin] = cosSin(angle), left = over(times(y, cos) - times(x, sin), length);
    angle += left + times(times(left, left), left) / 6n;
  }
  return angle;
}

// An angle as it is meant, its cosine and sine: multiples of 90 degrees are exact.
function direction(angle) {
  const quarter = angle / (Math.PI / 2);
  if (quarter !== Math.round(quarter)) return [many(angle), ...cosSin(many(angle))];
  return [(BigInt(quarter) * PI) / 2n, ...unit(angle).map(many)];
}

// --- unevaluated sums of two doubles ----------------------------------------------------------------------------------

function twoSum(a, b) {
  const s = a + b, v = s - a;
  return [s, (a - (s - v)) + (b - v)];
}

function half(angle, other, sign) {
  const [s, e] = twoSum(sign * angle[0], other[0]);
  return [s / 2, (e + sign * angle[1] + other[1]) / 2];
}

const sine = (/** @type {any[]} */ [x, rest]) => Math.sin(x) + rest * Math.cos(x);

// Angles nearer than this are one: some spacings of doubles.
const atRest = (phi) => 1e-14 + 4 * 2 ** (Math.floor(Math.log2(Math.abs(phi))) - 52);

// --- a + b cos(phi - start), b >= 0 ------------------------------------------------------------------------------------

class Cosine {
  constructor(a, b, start) {
    this.a = a; this.b = b; this.start = start;
    this.touches = magnitude(a - b) < SAME(b);
    this.from = split(start);
    this.turn = split(PI);
    this.twice = few(2n * b);
    const [least, most] = [a - b, a + b].map((x) => (magnitude(x) < SAME(b) ? 0n : x));
    if (least >= 0n) {
      const base = few(least);
      this.form = (x) => base + this.twice * sine(half(x, this.turn, -1)) ** 2;
    } else if (most <= 0n) {
      const top = few(most);
      this.form = (x) => top - this.twice * sine([x[0] / 2, x[1] / 2]) ** 2;
    } else {
      const cos = over(-a, b), zero = split(angleOf(cos, root(ONE - times(cos, cos))));
      this.form = (x) => this.twice * sine(half(x, zero, 1)) * sine(half(x, zero, -1));
    }
  }

  ahead(phi) {
    const [s, e] = twoSum(phi, -this.from[0]);
    return [s, e - this.from[1]];
  }

  at(phi) { return this.form(this.ahead(phi)); }

  root(phi) {
    if (!this.touches) return Math.sqrt(this.at(phi));
    const x = half(this.ahead(phi), [-this.turn[0], -this.turn[1]], 1);
    return Math.abs(Math.sin(x[0])) * 2 <= atRest(phi) ? 0 : Math.sqrt(this.twice) * sine(x);
  }
}

// --- gaps of groups between the crank and the frame ---------------------------------------------------------------------

const far = (z) => magnitude(many(z[0])) + magnitude(many(z[1]));
const alike = /** @type {Large} */ ((length, other, size) => (magnitude(length - other) <= times(MEANT, size) ? other : length));

const RECENT = 24, known = {};

const alikeIn = (a, b) => (typeof a === "number" ? a === b : a.every((x, i) => alikeIn(x, b[i])));

// What is made once for the same numbers: a mechanism asks for a few at all angles of its turn.
function once(name, numbers, make) {
  const recent = known[name] ??= [];
  for (const one of recent) if (alikeIn(one.numbers, numbers)) return one.made;
  if (!numbers.flat().every(Number.isFinite)) return null;
  const made = make();
  recent.unshift({ numbers, made });
  recent.length = Math.min(recent.length, RECENT);
  return made;
}

function gapOfArcs(/** @type {any[]} */ [l1, ahead, pivot, fixed], plus, minus = 0) {
  return once("arcs", [l1, ahead, pivot, fixed, plus, minus], () => {
    const r = many(l1), x = many(fixed[0]) - many(pivot[0]), y = many(fixed[1]) - many(pivot[1]);
    let length = many(plus) + many(minus);
    const square = times(x, x) + times(y, y), apart = root(square);
    if (minus) {
      length = alike(magnitude(length), minus > 0 ? r + apart : magnitude(r - apart),
        r + apart + magnitude(many(plus)) + magnitude(many(minus)) + far(pivot) + far(fixed));
    }
    return new Cosine(times(length, length) - square - times(r, r), 2n * times(r, apart), angleOf(x, y) - direction(ahead)[0]);
  });
}

function height(at, through, guide) {
  const [, cos, sin] = direction(guide), x = many(at[0]) - many(through[0]), y = many(at[1]) - many(through[1]);
  return [times(cos, y) - times(sin, x), cos, sin];
}

function gapsOfLine(l1, ahead, length, pivot, through, guide) {
  return once("line", [l1, ahead, length, pivot, through, guide], () => {
    const r = many(l1), rod = many(length), [e0] = height(pivot, through, guide);
    const start = direction(guide)[0] - direction(ahead)[0], size = r + rod + magnitude(e0) + far(pivot);
    const below = alike(rod + e0, r, size), above = alike(rod - e0, r, size);
    return [new Cosine(below, r, start + PI / 2n), new Cosine(above, r, start - PI / 2n)];
  });
}

function gapsOfArcs(span, l2, l3) {
  return once("both", [...span, l2, l3], () => {
    const p = gapOfArcs(span, l2, l3), q = gapOfArcs(span, l2, -l3);
    return [p, new Cosine(-q.a, q.b, q.start + PI)];
  });
}
