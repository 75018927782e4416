// The film of a sheet: step by step, as a hand draws it.

const film = { stops: [], at: -1, view: "", playing: false, speed: 1, first: new Map() };

// Stops of a sheet: the steps that leave a line in its frames, plan by plan and position by position, each behind what it is made of.
function stopsOf(sheet) {
  if (sheet.stops) return sheet.stops;
  const order = new Map(record.plans.map((plan, n) => [plan.id, n])), made = new Map(), seen = new Set(), stops = [];
  for (const id of Object.keys(record.steps)) for (const one of chain(id, seen)) made.set(one, made.size);
  for (const frame of sheet.frames.filter((f) => planOf(f.plan))) {
    // A line between two points is drawn when the later of them is there.
    const ends = (m) => [m.step, ...(m.name ?? "").split("–").map((one) => `${frame.plan}/${one}`)].filter((id) => made.has(id));
    const plan = planOf(frame.plan), own = sheet.marks.flatMap((m, n) => (m.frame === frame.id && m.step ? [{ m, n, id: ends(m).reduce((a, b) => (made.get(b) > made.get(a) ? b : a)) }] : []));
    const label = frame.position || sheet.live?.find((l) => l.view === frame.view)?.position || (plan.positions[0] ?? "");
    // A group is drawn when the first of its forces is.
    const forces = own.filter(({ m }) => frame.position && m.role === "vector").map(({ m }) => order.get(stepOf(m.step).plan) - 0.5);
    for (const id of new Set([...plan.steps.filter((one) => stepOf(one).helpers), ...own.map((one) => one.id)])) {
      const marks = own.filter((one) => one.id === id).map(({ n }) => n), helpers = at(stepOf(id).helpers, label) ?? [];
      const latest = Math.max(order.get(frame.plan), ...chain(id).map((one) => order.get(stepOf(one).plan)), forces.length ? Math.min(...forces) : 0);
      const place = [latest, plan.positions.indexOf(frame.plan === stepOf(id).plan ? frame.position : label), made.get(id), frame.id];
      if (marks.some((n) => !sheet.marks[n].geometry.text) || (marks.length && helpers.length)) stops.push({ frame, label, id, marks, helpers, place });
    }
  }
  return (sheet.stops = stops.sort((a, b) => { const n = a.place.findIndex((x, k) => x !== b.place[k]); return n < 0 ? 0 : a.place[n] - b.place[n]; }));
}

// A view is played with what its plans give elsewhere: how a link turns, by an arrow at the mechanism.
function takeFilm(view = "") {
  pause();
  const shown = leaf.sheet.frames.filter((frame) => frame.view === view), gives = (stop) => shown.some((frame) => frame.plan === stepOf(stop.id).plan && (frame.position || stop.label) === stop.label);
  film.view = view;
  film.stops = stopsOf(leaf.sheet).filter((stop) => !view || stop.frame.view === view || gives(stop));
  film.frames = new Set(film.stops.map((stop) => stop.frame.id));
  film.at = -1;
  film.first = new Map(film.stops.flatMap((stop, n) => stop.marks.map((mark) => [mark, n])).reverse());
  countStops();
}

function countStops() {
  $("count").textContent = `${film.at + 1} / ${film.stops.length}`;
  Object.assign($("scrub"), { max: film.stops.length, value: film.at + 1, ariaValueText: $("count").textContent });
}

const onPaper = (frame, z) => conj(sub(add(frame.origin, turnedBy(frame, z)), [0, leaf.height]));

// What the hand does for one helper: the compass sweeps about its centre over the cut, the ruler's line is drawn.
function strokeOf(helper, frame) {
  const a = onPaper(frame, helper.a);
  if (!a.every(Number.isFinite)) return null;
  if (helper.kind === "line") {
    const b = onPaper(frame, helper.b);
    return b.every(Number.isFinite) ? { d: `M${a.map(fixed).join(" ")}L${b.map(fixed).join(" ")}` } : null;
  }
  const r = helper.radius / Math.abs(frame.mu[0]);
  if (!(r > 0) || r > 3000) return null;
  if (helper.kind === "circle") return { d: arcPath(a, r, 0, 2 * Math.PI), centre: a };
  const b = onPaper(frame, helper.b), t = Math.atan2(a[1] - b[1], b[0] - a[0]), wide = clip(14 / r, 0.08, 0.6);
  return Number.isFinite(t) ? { d: arcPath(a, r, t - wide, t + wide), centre: a } : null;
}

const setAll = (element, attributes) => { for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value); };

function svgNode(name, attributes) {
  const found = document.createElementNS("http://www.w3.org/2000/svg", name);
  setAll(found, attributes);
  return found;
}

function reveal(n) {
  const now = film.stops[n], args = new Set(now ? stepOf(now.id).args.map((a) => a.step) : []);
  paint((mark, i) => {
    const first = film.first.get(i), here = now && (!mark.position || mark.position === now.label);
    if (first === undefined) return film.view && !film.frames.has(mark.frame) ? "later" : "past";
    if (first >= n) return first > n ? "later" : here && "now";
    return here && args.has(mark.step) && mark.frame === now.frame.id && "kin";
  });
  $("sheet").classList.remove("asked");
  $("sheet").classList.add("film");
}

// Draw one stop; resolves when the hand has done.
function drawStop(n, quick = still()) {
  const was = film.stops[film.at], stop = film.stops[n], hand = $("hand");
  film.at = n;
  countStops();
  hand.replaceChildren();
  if (!stop) { dim(); reveal(-1); invite(); return Promise.resolve(); }
  reveal(n);
  asked.label = stop.label;
  $("panel").replaceChildren(...tellStep(stop.id, stop.label), tellWhy(stop.id, stop.label));
  if (!was || was.frame !== stop.frame) fitBox(boundsOf(leaf.sheet.marks.filter((m) => m.frame === stop.frame.id)));
  const helped = stop.helpers.map((h) => strokeOf(h, stop.frame)).filter(Boolean), lines = stop.marks.map((mark) => leaf.sheet.marks[mark].geometry).filter((g) => !g.text && !g.fill);
  const strokes = helped.length ? helped : lines.map((g) => ({ d: pathOf(g, leaf.height), centre: null }));
  // Each stroke is drawn in its turn; the radius of an arc stands from the compass's needle as long as that is drawn.
  const each = quick ? 0 : Math.min(800, 2400 / strokes.length) / film.speed, marks = stop.marks.map((mark) => leaf.elements[mark]);
  const drawn = strokes.map(({ d, centre }, i) => {
    const path = svgNode("path", { class: "hand", d, pathLength: 1, "stroke-dasharray": "1 1" }), when = { duration: each, delay: i * each };
    hand.append(path);
    if (centre && each) {
      const end = path.getPointAtLength(path.getTotalLength()), leg = svgNode("line", { class: "leg", x1: centre[0], y1: centre[1], x2: end.x, y2: end.y });
      hand.append(leg);
      leg.animate([{ opacity: 0.75 }, { opacity: 0.75 }], when);
    }
    return path.animate([{ strokeDashoffset: 1 }, { strokeDashoffset: 0 }], { ...when, fill: "backwards" }).finished;
  });
  if (each) for (const mark of marks) mark.classList.add("later");
  const wait = new Promise((done) => setTimeout(done, (quick ? 700 : 500) / film.speed));
  return Promise.allSettled(drawn).then(() => {
    if (film.at === n) for (const mark of marks) mark.classList.remove("later");
    return wait;
  });
}

async function play() {
  if (film.at >= film.stops.length - 1) film.at = -1;
  film.playing = true;
  showPlaying();
  const run = (film.run = Symbol("run"));
  while (film.playing && film.run === run && film.at < film.stops.length - 1) await drawStop(film.at + 1);
  if (film.run === run) pause();
}

function pause() {
  film.playing = false;
  film.run = null;
  showPlaying();
}

const showPlaying = () => { if ($("play")) showRunning($("play"), film.playing); };

function stepTo(n, quick = false) {
  pause();
  drawStop(clip(n, -1, film.stops.length - 1), quick || still());
}

// Views of the sheet, each to be looked at and played by itself.
const viewsOf = (sheet) => [...new Set(stopsOf(sheet).map((stop) => stop.frame.view))];

function openView(name) {
  takeFilm(name);
  $("what").value = name;
  fitBox(boundsOf(leaf.sheet.marks.filter((m) => m.view === name)));
}

const viewList = () => chips("views of this sheet", viewsOf(leaf.sheet).map((name) => button(calledView(name), () => { openView(name); play(); }, { class: "chip" })));

function playerBar() {
  return [control("", "‹", "step back", () => stepTo(film.at - 1, true)), control("play", "▶", "play", () => (film.playing ? pause() : play()), { class: "play", "data-sign": "▶", "data-key": "play" }),
    control("", "›", "step", () => stepTo(film.at + 1)), range("scrub", "steps", { min: 0, value: 0 }, (at) => stepTo(at - 1, true)), node("span", { class: "count", id: "count" }),
    choice("what is played", [], "", (view) => { takeFilm(view); drawStop(-1); fit(); }, { id: "what" }),
    choice("speed", [0.5, 1, 2, 4].map((s) => [s, `×${String(s).replace(".", decimal())}`]), film.speed, (s) => { film.speed = Number(s); })];
}

const listFilms = () => $("what")?.replaceChildren(node("option", { value: "" }, say("the whole sheet")), ...viewsOf(leaf.sheet).map((name) => node("option", { value: name }, calledView(name))));
