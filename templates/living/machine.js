// The linkage in numbers: its program run for a crank angle and for given numbers, which may be other than those of the project.

const machine = { phi: 0, given: {}, made: {}, found: null, places: null, reach: null, watchers: [] };

function startMachine() {
  const m = record.motion;
  if (!m) return;
  const told = (x) => (x === null ? NaN : Array.isArray(x) ? x.map(told) : x && typeof x === "object"
    ? Object.fromEntries(Object.entries(x).map(([k, v]) => [k, told(v)])) : x);
  for (const [part, program] of Object.entries(PROGRAMS)) {
    m[part].program = program;
    m[part].constants = m[part].constants.map(told);
  }
  for (const g of m.givens) machine.made[g.name] = machine.given[g.name] = g.value;
}

// What searches find for the given numbers as they are.
const found = () => (machine.found?.given === machine.given ? machine.found : (machine.found = searched(machine.given)));

const isMade = (given) => Object.entries(machine.made).every(([name, value]) => given[name] === value);

// Parts of the results of a program at a crank angle, with what is found of the searches up to now.
function run({ program, inputs, constants }, phi, { given, start, courses, loads, wheel = /** @type {any} */ (null) }, assumed = []) {
  const turned = record.motion.sense * (phi - start);
  return program(inputs.map((input) => {
    if (input.given !== undefined) return given[input.given];
    if (input.angle !== undefined) return input.angle === "world" ? phi : turned;
    if (input.course !== undefined) return (courses[input.course] ?? NO_COURSE)[input.row];
    if (input.load !== undefined) return loads[input.load] ? rowOf(loads[input.load], input, turned) : NaN;
    if (input.friction !== undefined) return assumed[input.friction] ?? 0;
    if (input.wheel !== undefined) return wheel?.[input.wheel] ?? NaN;
    if (input.diagram !== undefined) return curveOf(input, given[input.diagram]);
    // What plans found that the page does not have holds for the project's own numbers alone.
    return isMade(given) ? input.found : NaN;
  }), constants, PRIMITIVES);
}

// Diagram of a load whose table is multiplied: the given one, stretched and moved; made once for a factor.
function curveOf(input, factor) {
  if (input.factor !== factor) {
    const [y, left, right] = ["y", "left", "right"].map((name) => input.drawn[name].map((one) => input.times * factor * one + (name === "y" ? input.plus : 0)));
    Object.assign(input, { factor, curve: { ...input.drawn, y, left, right } });
  }
  return input.curve;
}

const MOST = 400, DAMPED = 60, SETTLED = 1e-13;

// The same with friction: approximations until every reaction stays, as methods/linkage/approximations.py does.
function settled(phi, now) {
  const pairs = record.motion.searches.friction, { all } = record.motion, reaction = (pair, values) => argumentOf(pair.force, values, now.given, all);
  let assumed = pairs.map(() => 0);
  for (let n = 0; n < MOST; n++) {
    const values = run(all, phi, now, assumed), most = Math.max(...pairs.map((pair) => size(reaction(pair, values))));
    const next = pairs.map((pair) => {
      const force = reaction(pair, values);
      return pair.slides ? Math.sign(plainCross(argumentOf(pair.slides, values, now.given, all), force)) : size(force);
    });
    if (n && next.every((x, i) => !(Math.abs(x - assumed[i]) > SETTLED * (pairs[i].slides ? 1 : most)))) return run(all, phi, now, next);
    assumed = next.map((x, i) => (n > DAMPED && !pairs[i].slides ? (x + assumed[i]) / 2 : x));
  }
  return run(all, phi, now, pairs.map(() => NaN));
}

// Parts of all results at a crank angle, rad, counter-clockwise from the x axis; made once for all who ask at one angle.
function parts(phi) {
  const { given, now } = machine;
  if (now?.phi === phi && now.given === given) return now.values;
  const values = record.motion.searches.friction.length ? settled(phi, found()) : run(record.motion.all, phi, found());
  machine.now = { phi, given, values };
  return values;
}

// A result by its place among the parts.
const taken = ([place, count], values) => (count === 2 ? [values[place], values[place + 1]] : values[place]);

const valuesAt = (phi) => Object.fromEntries(Object.entries(record.motion.all.results).map(([id, place]) => [id, taken(place, parts(phi))]));

function turn(phi) {
  machine.phi = phi;
  for (const watcher of machine.watchers) watcher();
}

// In a hurry, while the hand moves it, what searches found stays, as long as the mechanism is there with it: they search when it rests.
function setGiven(name, value, hurry = false) {
  if (!(name in machine.made)) throw new RangeError(`no given number ${name}`);
  const before = hurry && found();
  machine.given = { ...machine.given, [name]: value };
  if (before) machine.found = { ...before, given: machine.given };
  if (before && notThere(parts(machine.phi))) Object.assign(machine, { now: null, found: { ...machine.found, courses: coursesOf(machine.given) } });
  for (const watcher of machine.watchers) watcher(name);
}
