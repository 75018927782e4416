// The linkage in numbers: its program run for a crank angle and for given numbers, which may be other than those of the project.

const machine = { phi: 0, given: {}, made: {}, watchers: [] };

function startMachine() {
  const m = record.motion;
  if (!m) return;
  const told = (x) => (x === null ? NaN : Array.isArray(x) ? x.map(told) : x && typeof x === "object"
    ? Object.fromEntries(Object.entries(x).map(([k, v]) => [k, told(v)])) : x);
  m.constants = m.constants.map(told);
  for (const input of m.inputs) if ("fixed" in input) input.fixed = told(input.fixed);
  for (const g of m.givens) machine.made[g.name] = machine.given[g.name] = g.value;
}

// Value of a row that follows strokes, at an angle turned.
function byStroke({ borders, at: there, between }, turned, period) {
  const t = mod(turned, period);
  for (let i = 0; i < borders.length; i++) {
    if (Math.abs(t - borders[i]) < NEAR || (i === 0 && period - t + borders[0] < NEAR)) return there[i];
  }
  const i = upTo(borders, t) - 1;
  return between[i < 0 ? borders.length - 1 : i];
}

// Parts of all results at a crank angle, rad, counter-clockwise from the x axis.
function parts(phi, given = machine.given) {
  const m = record.motion, turned = m.sense * (phi - m.start);
  const x = m.inputs.map((input) => ("given" in input ? given[input.given] : "fixed" in input ? input.fixed
    : "strokes" in input ? byStroke(input.strokes, turned, m.period) : input.angle === "world" ? phi : turned));
  return PROGRAM(x, m.constants, PRIMITIVES);
}

function valuesAt(phi) {
  const found = parts(phi), named = {};
  for (const [id, [place, count]] of Object.entries(record.motion.results)) {
    named[id] = count === 2 ? [found[place], found[place + 1]] : found[place];
  }
  return named;
}

function turn(phi) {
  machine.phi = phi;
  for (const watcher of machine.watchers) watcher();
}

function setGiven(name, value) {
  if (!(name in machine.made)) throw new RangeError(`no given number ${name}`);
  machine.given = { ...machine.given, [name]: value };
  for (const watcher of machine.watchers) watcher(name);
}
