// How unevenly a crank runs with its flywheel: the works over the cycle, their greatest change, the moment of inertia, as
// methods/flywheel constructs them on paper. Scale factors change nothing of it, so all numbers here are SI.

const BENT = 0.05, STEEP = 3, CURVED = 720, FINER = 32, CORNER = 0.05;
const NO_WORK = 1e-9, NO_HEIGHT = 1e-12, FLAT = 4e-15, STILL = 1e-15;

const sums = (values) => values.reduce((found, x) => [...found, found.at(-1) + x], [0]);
const ascending = (numbers) => [...new Set(numbers)].sort((a, b) => a - b);
const widths = (edges) => edges.slice(1).map((b, i) => b - edges[i]);
const middles = (edges) => edges.slice(1).map((b, i) => (edges[i] + b) / 2);

// Borders of the intervals: the positions, the jumps of the moment, and where it bends much. `energy` is the links' greatest.
function bordersOf(positions, jumps, period, moment, energy) {
  let edges = ascending([...positions, period, ...jumps.filter((t) => t > 0 && t < period)]);
  edges = edges.filter((t, i) => !i || t - edges[i - 1] > 1e-9 * period);
  for (;;) {
    const h = widths(edges), at = middles(edges), y = at.map((t) => moment(t, 1)), span = reach(sums(y.map((one, i) => one * h[i])));
    if (span <= NO_WORK * energy) return edges;
    const bent = at.filter((t, i) => h[i] * Math.abs(2 * y[i] - moment(edges[i], 1) - moment(edges[i + 1], -1)) / 6 > BENT * span);
    if (!bent.length) return edges;
    edges = ascending([...edges, ...bent]);
  }
}

// Graph of work by chords: the ordinate in the middle of each interval, slopes by those at its ends.
function workOf(edges, moment) {
  const h = widths(edges), y = middles(edges).map((t) => moment(t, 1)), left = [], right = [];
  y.forEach((chord, i) => {
    const ends = [moment(edges[i], 1), moment(edges[i + 1], -1)], along = ends.map((one) => one * chord), square = chord * chord;
    const limited = Math.min(...along) >= -NO_HEIGHT * square && square > 0;
    [left[i], right[i]] = ends.map((one, n) => (limited && along[n] > STEEP * square ? STEEP * chord : one));
  });
  return { x: edges, y: sums(y.map((one, i) => one * h[i])), left, right, law: "cubic" };
}

// Greatest value of a function over a cycle: the best of some samples, which separate its humps, and what is greater beside it.
function greatest(f, samples) {
  const values = samples.map(f), last = samples.length - 1, best = indexOfGreatest(values);
  if (!values.every(Number.isFinite)) return NaN;
  return Math.max(...(best && best < last ? [best] : [0, last]).map((k) => beside(f, samples, k, values[k])));
}

const indexOfGreatest = (values) => values.reduce((k, y, i) => (y > values[k] ? i : k), 0);

function beside(f, samples, k, value) {
  let best = samples[k];
  const whole = samples.at(-1) - samples[0], near = 1e-9 * whole; // what differs by rounding is no neighbour
  let low = samples.findLast((t) => t < best - near) ?? samples[0], high = samples.find((t) => t > best + near) ?? samples.at(-1);
  while (high - low > STILL * whole) {
    const t = spread(low, high, FINER + 1), y = t.map(f), j = indexOfGreatest(y), part = (high - low) / FINER;
    if (y[j] > value) [best, value] = [t[j], y[j]];
    if (value - Math.min(y[Math.max(j - 1, 0)], y[Math.min(j + 1, FINER)]) <= FLAT * Math.abs(value)) break;
    [low, high] = [Math.max(best - part, low), Math.min(best + part, high)];
  }
  return value;
}

// Constant moment that balances the cycle, and what turns with the crank of the finished machine, kg m2. `mass` is the reduced moment of
// inertia of all links, `wheel` has { method, alone, added or delta, rotor, crank, omega }.
function runningOf(wheel, positions, jumps, period, moment, mass) {
  const { method, delta, added, rotor = 0, crank, omega } = wheel, square = omega * omega / 2;
  const edges = bordersOf(positions, jumps, period, moment, Math.max(...positions.map(mass)) * square);
  const work = workOf(edges, moment), M = -work.y.at(-1) / period;
  if (added !== undefined) return { M, J: added + crank };
  const samples = ascending([...spread(0, period, CURVED + 1), ...edges]), known = new Map();
  const others = (t) => {
    if (!known.has(t)) known.set(t, [ordinateOf(work, t) + M * t, method === "wittenbauer" ? mass(t) : wheel.alone ? 0 : mass(t) - crank]);
    return known.get(t);
  };
  const end = (side, speed) => side * greatest((t) => { const [energy, inertia] = others(t); return side * (energy - square * speed * speed * inertia); }, samples);
  const ab = method === "wittenbauer" ? end(1, 1 + delta / 2) - end(-1, 1 - delta / 2) : Math.abs(end(1, 1) - end(-1, 1));
  const first = ab / (delta * omega * omega) + (method === "wittenbauer" ? crank : 0);
  return { M, J: first + Math.max(crank + rotor - first, 0) };
}

// Angles turned where a load that follows strokes is not smooth.
function jumpsOf({ runs, load, tables, same, share, endless }, given) {
  const { period } = record.motion, found = [];
  runs.forEach((run2, i) => {
    const last = (i || runs.length) - 1, before2 = runs[last];
    if (!meets(before2, run2)) found.push(before2.end, run2.begin);
    else if (!same(last, i) || (!endless && run2.stroke !== before2.stroke)) found.push(run2.begin);
    const diagram = tables[i] >= 0 && load.diagrams[tables[i]];
    if (diagram && share) for (const x of cornersOf(diagram, given)) found.push(...crossingsOf(run2, share, [x]));
  });
  return distinct(found.map((t) => mod(t, period)), period);
}

// Where the diagram of a load jumps, or has a corner that shows.
function cornersOf(name, given) {
  const input = record.motion.wheel.inputs.find((one) => one.diagram === name), { x, y, law } = curveOf(input, given[name]);
  const most = Math.max(...y.map(Math.abs)), found = [];
  for (let i = 0; i + 1 < x.length; i++) {
    if (x[i] === x[i + 1]) { if (y[i] !== y[i + 1]) found.push(x[i]); continue; }
    if (law === "cubic" || !i || x[i - 1] === x[i]) continue;
    const chord = y[i - 1] + (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]) * (y[i + 1] - y[i - 1]);
    if (Math.abs(y[i] - chord) >= CORNER * most) found.push(x[i]);
  }
  return found;
}

// Angles in order, each once; two that differ by rounding are one, also across the end of the period.
const distinct = (angles, period) => angles.map((t) => (period - t < NEAR ? 0 : t)).sort((a, b) => a - b)
  .reduce((kept, t) => (!kept.length || t - kept.at(-1) > NEAR ? [...kept, t] : kept), []);

// The same of the linkage, for what the searches have found up to now; nothing where the crank runs evenly.
function wheelOf(found) {
  const { wheel, period, sense } = record.motion;
  if (!wheel) return undefined;
  const known = new Map(), of = (t) => {
    if (!known.has(t)) known.set(t, run(wheel, found.start + sense * t, found));
    return known.get(t);
  };
  const result = (name) => (t) => of(t)[wheel.results[name][0]], one = (name) => (name in wheel.results ? result(name)(0) : undefined);
  const [before2, behind, mass] = ["before", "behind", "mass"].map(result), { parts } = wheel;
  const positions = parts ? partsOf(found.stroke, ...parts) : wheel.positions;
  const jumps = [...wheel.jumps, ...found.loads.flatMap((motion) => (motion.lost ? [NaN] : jumpsOf(motion, found.given)))];
  const named = Object.fromEntries(["added", "delta", "rotor", "crank", "omega"].map((name) => [name, one(name)]));
  if ([...positions, ...jumps].some(Number.isNaN)) return { M: NaN, J: NaN, crank: named.crank };
  const { M, J } = runningOf({ ...wheel, ...named }, positions, distinct(jumps, period), period, (t, side) => (side < 0 ? before2 : behind)(t), mass);
  return { M, J, crank: named.crank };
}

// Angles turned where the working stroke and the rest of each turn are divided into equal parts.
const partsOf = (stroke, working, idle, turns) => Array.from({ length: turns }, (_, n) => [
  ...Array.from({ length: working }, (_2, i) => stroke / working * i),
  ...Array.from({ length: idle }, (_2, i) => stroke + (TURN - stroke) / idle * i)].map((t) => t + TURN * n)).flat();
