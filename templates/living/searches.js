// What searches find for given numbers: ways of assembly, where the cycle begins, strokes of the loads, how the crank runs. On the page's own program.

// One set of given numbers with what is found for it; the program is run without what comes later.
function searched(given) {
  const m = record.motion, found = { given, start: m.searches.dead ? NaN : m.start, courses: coursesOf(given), loads: [] };
  const at = remembered((phi) => run(m.watched, phi, found)), asked = (arg) => (phi) => argumentOf(arg, at(phi), given);
  if (m.searches.dead) [found.start, found.stroke] = startOf(m.searches.dead, asked, given);
  for (const load of m.searches.loads) found.loads.push(motionOf(load, asked, found.start));
  found.wheel = wheelOf(found);
  return found;
}

// Ways of assembly of the groups of class III, one after another.
function coursesOf(given) {
  const m = record.motion, found = { given, start: NaN, courses: [], loads: [] };
  const legsAt = ({ legs }) => (phi) => { const values = run(m.watched, phi, found); return pointed(legs.map((arg) => argumentOf(arg, values, given))); };
  for (const course of m.searches.courses) found.courses.push(courseOf(legsAt(course), course.at, course.near));
  return found.courses;
}

function argumentOf(arg, values, given, of = record.motion.watched) {
  if (arg.given !== undefined) return given[arg.given];
  if (arg.step === undefined) return arg.value;
  return taken(of.results[arg.step], values);
}

// World angle of the crank where the working stroke of the output begins, or of the stroke that K asks for, and its width.
function startOf(dead, asked, given) {
  const { sense } = record.motion, [place, speed] = [asked(dead.place), asked(dead.speed)];
  const hinges = dead.hinges.map((arg) => asked(arg)(0));
  const way = wayOf((t) => place(sense * t), (t) => speed(sense * t), dead.axis, hinges, given["crank.length"]);
  const runs = way ? runsOf(way.speed) : [];
  if (runs.length < 2) return [NaN, NaN];
  const ways = runs.map((r) => way.travelled(r.begin)), stroke = workingStroke(inStrokes(runs, ways));
  if (!stroke || !(reach(ways) > 1e-9 * given["crank.length"])) return [NaN, NaN];
  const width = dead.stroke ?? stroke[1] - stroke[0];
  return [sense * (stroke[0] + (stroke[1] - stroke[0] - width) / 2), width];
}

// How the output of a load moves: its runs over the cycle; its way from the lowest place on, how long that is, which run follows another.
function motionOf(load, asked, start) {
  const { sense, period } = record.motion, world = (t) => start + sense * t;
  const none = { runs: [], low: NaN, long: NaN, way: 1, lost: true };
  const speed = asked(load.speed), turning = load.turns !== undefined, place = asked(turning ? load.turns : load.place);
  const along = (t) => { const z = place(world(t)); return turning ? load.sense * Math.atan2(z[1], z[0]) : plainDot(z, load.sense); };
  const runs = runsOf((t) => { const v = speed(world(t)); return turning ? load.sense * v : plainDot(v, load.sense); });
  if (!runs.length) return none;
  let ways = runs.map((r) => along(r.begin));
  if (turning) {
    const t = [...new Set([...spread(0, TURN, SWEEP + 1), ...runs.map((r) => r.begin)])].sort((a, b) => a - b), angles = unwrapped(t.map(along));
    const turns = Math.round((angles.at(-1) - angles[0]) / TURN);
    if (turns || !runs.some((r) => r.sense)) {
      const cut = runs.flatMap((r) => (r.end > TURN + NEAR ? [{ ...r, end: TURN }, { begin: 0, end: r.end - TURN, sense: r.sense, stroke: 0, working: false }] : [r]));
      const whole = cut.map((r) => ({ ...r, working: turns > 0 })).sort((a, b) => a.begin - b.begin);
      return actingOn(load, { runs: overCycle(whole, period, load.first), low: NaN, long: NaN, way: turns >= 0 ? 1 : -1, endless: true });
    }
    ways = runs.map((r) => angles[t.indexOf(r.begin)]);
  }
  const low = Math.min(...ways), long = reach(ways);
  if (!(long > (turning ? 0 : 1e-9 * machine.given["crank.length"]))) return none;
  const share = turning ? (t) => swung(place(world(t)), load.sense, low, long) : (t) => clip((along(t) - low) / long, 0, 1);
  const found = { runs: overCycle(inStrokes(runs, ways), period, load.first), low, long, way: 1, share };
  if (turning || (load.from === 0 && load.to === 1)) return actingOn(load, found);
  return actingOn(load, { ...found, runs: found.runs.flatMap((r) => within(r, share, load.from, load.to)) });
}

// Angles inside a run where it passes some fractions of the way.
function crossingsOf(run2, share, fractions) {
  const ends = [share(run2.begin), share(run2.end)].sort((a, b) => a - b);
  return fractions.filter((x) => run2.sense && ends[0] + NEAR < x && x < ends[1] - NEAR)
    .map((x) => rootOf((t) => run2.sense * (share(t) - x), run2.begin, run2.end)).sort((a, b) => a - b);
}

// The parts of a run between two fractions of the way.
function within(run2, share, from, to) {
  const borders = [run2.begin, ...crossingsOf(run2, share, [from, to].filter((x) => x > 0 && x < 1)), run2.end];
  return borders.slice(1).map((end, i) => ({ ...run2, begin: borders[i], end })).filter(({ begin, end }) => { const x = share((begin + end) / 2); return x >= from && x <= to; });
}

// Which diagram acts on each run, with which sign, and where one run goes on as the one before it.
function actingOn(load, motion) {
  const { runs } = motion, many = load.tables.length, strokes = new Set(runs.map((r) => r.stroke)).size;
  if (strokes % many) return { runs: [], low: NaN, long: NaN, way: 1, lost: true };
  const tables = runs.map((r) => ((load.stroke === "both" || (load.stroke === "working") === r.working) && load.tables[r.stroke % many] ? r.stroke % many : -1));
  const signs = runs.map((r) => load.times * (load.against === undefined ? 1 : load.against * r.sense));
  const same = (a, b) => (a + 1) % runs.length === b && meets(runs[a], runs[b]) && tables[a] === tables[b] && signs[a] === signs[b];
  return { ...motion, load, tables, signs, same };
}

// Whether a run begins where another ends.
const meets = (a, b) => Math.abs(mod((b.begin - a.end) * TURN / record.motion.period + Math.PI, TURN) - Math.PI) < NEAR;

// What a load's row is at an angle turned; at a jump its side counts.
function rowOf(motion, input, turned) {
  if (input.row === "low" || input.row === "long") return motion[input.row];
  if (motion.lost || Number.isNaN(turned)) return NaN;
  const { period } = record.motion, { runs } = motion, { side = 0 } = input;
  let i = runAt(runs, period, turned, motion.load.always && !side ? 1 : side);
  if (i < 0 && !side) {
    const [a, b] = [runAt(runs, period, turned, -1), runAt(runs, period, turned, 1)];
    if (a >= 0 && b >= 0 && motion.same(a, b)) i = b;
  }
  if (input.row === "ahead") return i < 0 ? 1 : (side || 1) * runs[i].sense * motion.way;
  return i >= 0 && motion.tables[i] === input.table ? motion.signs[i] : 0;
}
