// How unevenly a crank runs with its flywheel: the works over the cycle, their greatest change, the moment of inertia, as
// methods/flywheel constructs them on paper. Scale factors change nothing of it, so all numbers here are SI.

const BENT = 0.02, STEEP = 3, CURVED = 720, FINER = 32, CORNER = 0.05;
const NO_WORK = 1e-9, NO_HEIGHT = 1e-12, FLAT = 4e-15, STILL = 1e-15;

const ascending = (numbers) => [...new Set(numbers)].sort((a, b) => a - b);

// Graph of work by chords: the ordinate in the middle of each interval, slopes by those at its ends. The intervals lie between the positions
// and the jumps of the moment, halved where it bends much. `energy` is the links' greatest.
function workOf(positions, jumps, period, moment, energy) {
  let x = ascending([...positions, period, ...jumps.filter((t) => t > 0 && t < period)]);
  x = x.filter((t, i) => !i || t - x[i - 1] > 1e-9 * period);
  for (;;) {
    const pieces = x.slice(1).map((to, i) => ({ middle: (x[i] + to) / 2, wide: to - x[i], chord: moment((x[i] + to) / 2, 1), ends: [moment(x[i], 1), moment(to, -1)] }));
    const y = pieces.reduce((sums, { wide, chord }) => [...sums, sums.at(-1) + chord * wide], [0]), span = reach(y);
    const bent = pieces.filter(({ wide, chord, ends: [a, b] }) => span > NO_WORK * energy && wide * Math.abs(2 * chord - a - b) / 6 > BENT * span);
    if (!bent.length) return { x, y, left: pieces.map((one) => slopeOf(one, 0)), right: pieces.map((one) => slopeOf(one, 1)), law: "cubic" };
    x = ascending([...x, ...bent.map(({ middle }) => middle)]);
  }
}

// Slope at an end of an interval, no steeper than keeps the curve between its ends.
function slopeOf({ chord, ends }, n) {
  const limited = ends.every((one) => one * chord >= -NO_HEIGHT * chord * chord) && ends[n] * chord > STEEP * chord * chord && chord * chord > 0;
  return limited ? STEEP * chord : ends[n];
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
function runningOf({ method, alone = false, delta, added, rotor = 0, crank, omega }, positions, jumps, period, moment, mass) {
  const square = omega * omega / 2, work = workOf(positions, jumps, period, moment, Math.max(...positions.map(mass)) * square), M = -work.y.at(-1) / period;
  if (added !== undefined) return { M, J: added + crank };
  const all = method === "wittenbauer", others = remembered((t) => [read(work, t, 1, 0) + M * t, all ? mass(t) : alone ? 0 : mass(t) - crank]);
  const samples = ascending([...spread(0, period, CURVED + 1), ...work.x]);
  const end = (side, speed) => side * greatest((t) => { const [energy, inertia] = others(t); return side * (energy - square * speed * speed * inertia); }, samples);
  const ab = all ? end(1, 1 + delta / 2) - end(-1, 1 - delta / 2) : Math.abs(end(1, 1) - end(-1, 1)), first = ab / (delta * omega * omega) + (all ? crank : 0);
  return { M, J: Math.max(first, crank + rotor) };
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
  return found.map((t) => mod(t, period));
}

// Where the diagram of a load jumps, or has a corner that shows.
function cornersOf(name, given) {
  const input = record.motion.wheel.inputs.find((one) => one.diagram === name), { x, y, law } = curveOf(input, given[name]);
  const most = Math.max(...y.map(Math.abs)), chord = (i) => y[i - 1] + (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]) * (y[i + 1] - y[i - 1]);
  const isCorner = (i) => law !== "cubic" && i > 0 && x[i - 1] !== x[i] && Math.abs(y[i] - chord(i)) >= CORNER * most;
  return x.filter((at, i) => i + 1 < x.length && (at === x[i + 1] ? y[i] !== y[i + 1] : isCorner(i)));
}

// Angles in order, each once; two that differ by rounding are one, also across the end of the period.
const distinct = (angles, period) => angles.map((t) => (period - t < NEAR ? 0 : t)).sort((a, b) => a - b)
  .reduce((kept, t) => (!kept.length || t - kept.at(-1) > NEAR ? [...kept, t] : kept), []);

// The same of the linkage, for what the searches have found up to now; nothing where the crank runs evenly.
function wheelOf(found) {
  const { wheel, period, sense } = record.motion;
  if (!wheel) return undefined;
  const at = remembered((t) => run(wheel, found.start + sense * t, found)), [before2, behind, mass] = ["before", "behind", "mass"].map((name) => (t) => taken(wheel.results[name], at(t)));
  const own = Object.fromEntries(Object.entries(wheel.results).map(([name, place]) => [name, taken(place, at(0))])), positions = wheel.parts ? partsOf(found.stroke, wheel.parts) : wheel.positions;
  const jumps = [...wheel.jumps, ...found.loads.flatMap((motion) => (motion.lost ? [NaN] : jumpsOf(motion, found.given)))];
  if ([...positions, ...jumps].some(Number.isNaN)) return { M: NaN, J: NaN, crank: own.crank };
  return { ...runningOf({ ...wheel, ...own }, positions, distinct(jumps, period), period, (t, side) => (side < 0 ? before2 : behind)(t), mass), crank: own.crank };
}

// Angles turned where the working stroke and the rest of each turn are divided into equal parts.
function partsOf(stroke, [working, idle, turns]) {
  const turn = [...spread(0, stroke, working + 1).slice(0, -1), ...spread(stroke, TURN, idle + 1).slice(0, -1)];
  return Array.from({ length: turns }, (_, n) => turn.map((t) => t + TURN * n)).flat();
}
