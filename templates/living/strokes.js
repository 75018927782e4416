// Strokes of an output over one turn of the crank, as methods/linkage/cycle.py finds them; words and numbers are told there.

const TURN = 2 * Math.PI, SWEEP = 720;
const NO_MOTION = 1e-12, SHALLOW = 0.01, ALIKE_WAY = 1e-9;

// Zero of a function between two arguments where its signs differ, to the last bit.
function rootOf(f, low, high) {
  const sign = Math.sign(f(high));
  for (;;) {
    const middle = (low + high) / 2;
    if (!(low < middle && middle < high)) return middle;
    if (sign * f(middle) > 0) high = middle; else low = middle;
  }
}

// A function that keeps what it gave: searches look at the same angles again and again.
function remembered(f) {
  const known = new Map();
  return (x) => { if (!known.has(x)) known.set(x, f(x)); return known.get(x); };
}

const spread = (from, to, many) => Array.from({ length: many }, (_, i) => from + (to - from) * i / (many - 1));
const swept = Array.from({ length: SWEEP }, (_, i) => i * (TURN / SWEEP));

function withDips(speed, t, v, still) {
  const most = Math.max(...v.map(Math.abs)), n = t.length, extra = [];
  for (let i = 0; i < n; i++) {
    const before = v[(i + n - 1) % n], after = v[(i + 1) % n], size = Math.abs(v[i]);
    if (!(size < SHALLOW * most && size <= Math.abs(before) && size <= Math.abs(after))) continue;
    if (!(Math.min(Math.abs(before), Math.abs(after)) > still && Math.sign(before) === Math.sign(after))) continue;
    let best = t[i], wide = TURN / n;
    for (let k = 0; k < 4; k++) {
      const x = spread(best - wide, best + wide, 65), y = x.map((one) => Math.sign(before) * speed(one)), least = Math.min(...y);
      best = x[y.indexOf(least)];
      wide /= 16;
      if (least < -still) { extra.push(mod(best, TURN)); break; }
    }
  }
  if (!extra.length) return [t, v];
  const all = [...t, ...extra].sort((a, b) => a - b);
  return [all, all.map(speed)];
}

// Runs of one turn from the sign of a speed; none where it is not defined all the way round.
function runsOf(speed) {
  let t = swept, v = t.map(speed);
  if (v.some(Number.isNaN)) return [];
  const still = NO_MOTION * Math.max(...v.map(Math.abs));
  [t, v] = withDips(speed, t, v, still);
  const n = t.length, signs = v.map((x) => (Math.abs(x) <= still ? 0 : Math.sign(x))), moving = signs.flatMap((s, i) => (s ? [i] : []));
  if (!moving.length) return [{ begin: 0, end: TURN, sense: 0, stroke: 0, working: false }];
  const ends = [];
  moving.forEach((i, k) => {
    const j = moving[(k + 1) % moving.length], zeros = mod(j - i - 1, n);
    const after = (m) => t[(i + m) % n] + TURN * Math.floor((i + m) / n);
    if (zeros > 1) {
      ends.push([rootOf((x) => still - Math.abs(speed(x)), after(0), after(1)), 0]);
      ends.push([rootOf((x) => Math.abs(speed(x)) - still, after(zeros), after(zeros + 1)), signs[j]]);
    } else if (signs[i] !== signs[j]) ends.push([zeros ? after(1) : rootOf(speed, after(0), after(1)), signs[j]]);
  });
  if (!ends.length) return [{ begin: 0, end: TURN, sense: signs[moving[0]], stroke: 0, working: false }];
  const borders = ends.map(([angle, sense]) => [mod(angle, TURN), sense]).sort((a, b) => a[0] - b[0]);
  return borders.map(([begin, sense], k) => ({ begin, end: k + 1 < borders.length ? borders[k + 1][0] : borders[0][0] + TURN, sense, stroke: 0, working: false }));
}

const later = (run, angle, strokes = 0) => ({ ...run, begin: run.begin + angle, end: run.end + angle, stroke: run.stroke + strokes });

// Runs of one turn with their strokes; the ways tell how far the output is where each begins.
function inStrokes(runs, ways) {
  const low = Math.min(...ways), high = Math.max(...ways), near = ALIKE_WAY * (high - low), many = runs.length;
  const marks = ways.flatMap((way, k) => (way >= high - near ? [[k, 1]] : way <= low + near ? [[k, -1]] : []));
  const working = runs.map(() => false);
  marks.forEach(([k, at], i) => {
    const [n, to] = marks[(i + 1) % marks.length];
    if (at === -1 && to === 1 && high > low) for (let m = k; m < (n > k ? n : n + many); m++) working[m % many] = true;
  });
  const first = Math.max(working.findIndex((w, k) => w !== working[(k + many - 1) % many]), 0);
  let number = -1;
  return Array.from({ length: many }, (_, m) => {
    const i = (first + m) % many;
    if (!m || working[i] !== working[(i + many - 1) % many]) number++;
    return later({ ...runs[i], stroke: number, working: working[i] }, TURN * Math.floor((first + m) / many));
  });
}

// Begin and end of the working stroke, of several the longest.
function workingStroke(runs) {
  const numbers = [...new Set(runs.filter((r) => r.working).map((r) => r.stroke))], ends = numbers.map((n) => runs.filter((r) => r.stroke === n)).map((own) => [own[0].begin, own.at(-1).end]);
  return ends.reduce((best, one) => (best && best[1] - best[0] >= one[1] - one[0] ? best : one), null);
}

// Runs of one turn over all turns of the cycle, numbered from the stroke that begins nearest to an angle.
function overCycle(runs, period, first) {
  const perTurn = runs.at(-1).stroke + 1, turns = Math.round(period / TURN);
  const every = Array.from({ length: turns }, (_, n) => runs.map((r) => later(r, TURN * n, perTurn * n))).flat();
  const apart = (r) => Math.abs(mod((r.begin - first) * TURN / period + Math.PI, TURN) - Math.PI);
  let start = 0;
  every.forEach((r, i) => { if ((i === 0 || r.stroke !== every[i - 1].stroke) && apart(r) < apart(every[start])) start = i; });
  const shift = every[start].stroke, strokes = perTurn * turns;
  return [...every.slice(start), ...every.slice(0, start).map((r) => later(r, period))].map((r) => ({ ...r, stroke: mod(r.stroke - shift, strokes) }));
}

// Number of the run at an angle turned, -1 where there is none; the side says which of two that meet there counts.
function runAt(runs, period, turned, side = 0) {
  let found = -1;
  runs.forEach((r, i) => {
    let into = mod(turned - r.begin, period);
    const width = r.end - r.begin;
    if (side < 0) { if (into <= NEAR) into += period; } else if (period - into < NEAR) into = 0;
    if (side < 0 ? into < width + NEAR : side > 0 ? into < width - NEAR : into > NEAR && into < width - NEAR) found = i;
  });
  return found;
}

// --- the way of an output ------------------------------------------------------------------------------------------------

// Angles one after another without jumps of a turn.
function unwrapped(angles) {
  let [last] = angles;
  return angles.map((a) => (last = a - TURN * Math.round((a - last) / TURN)));
}

const reach = (values) => Math.max(...values) - Math.min(...values);

// Of a point positive where it goes along the axis, of one that swings about a fixed hinge where its chord does; null where it has none.
function wayOf(place, speed, axis, hinges, crank) {
  const path = spread(0, TURN, SWEEP + 1).map(place);
  const centre = path.some((z) => Number.isNaN(z[0])) ? undefined : hinges.find((hinge) => {
    const apart = path.map((z) => size(sub(z, hinge)));
    return Math.min(...apart) > 0 && reach(apart) < 1e-9 * crank;
  });
  if (!centre) return { travelled: (t) => plainDot(place(t), axis), speed: (t) => plainDot(speed(t), axis) };
  const radius = size(sub(path[0], centre)), angle = (z) => Math.atan2(z[1] - centre[1], z[0] - centre[0]), angles = unwrapped(path.map(angle));
  const highest = Math.max(...angles), lowest = Math.min(...angles);
  const ahead = plainDot(sub(path[angles.indexOf(highest)], path[angles.indexOf(lowest)]), axis);
  if (Math.round((angles.at(-1) - angles[0]) / TURN) || !(Math.abs(ahead) > 1e-9 * crank)) return null;
  const way = Math.sign(ahead), middle = cis(-(highest + lowest) / 2);
  return {
    travelled: (t) => { const z = mul(sub(place(t), centre), middle); return way * radius * Math.atan2(z[1], z[0]); },
    speed: (t) => { const d = sub(place(t), centre); return way * plainDot(speed(t), [-d[1], d[0]]) / radius; },
  };
}
