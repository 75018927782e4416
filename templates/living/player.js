// The film of a sheet: step by step, as a hand draws it.

const film = { stops: [], at: -1, view: "", playing: false, speed: 1, first: new Map() };

// Stops of a sheet: for each frame, in the order of construction, the steps that leave a line.
function stopsOf(sheet) {
  const order = new Map(record.plans.map((plan, n) => [plan.id, n])), stops = [];
  const steps = new Map(Object.keys(record.steps).map((id, n) => [id, n]));
  // A group is drawn with its forces: when they are there.
  const drawnAt = (f) => Math.max(order.get(f.plan) ?? 1e6, ...(f.position ? sheet.marks.filter((m) => m.frame === f.id && m.role === "vector" && m.step)
    .map((m) => order.get(stepOf(m.step).plan) - 0.5) : []));
  const places = new Map(sheet.frames.map((f) => [f, [drawnAt(f), planOf(f.plan)?.positions.indexOf(f.position) ?? 0, f.id]]));
  const place = (f) => places.get(f);
  const frames = sheet.frames.filter((f) => planOf(f.plan)).sort((a, b) => { const p = place(a), q = place(b); return p[0] - q[0] || p[1] - q[1] || p[2] - q[2]; });
  for (const frame of frames) {
    const plan = planOf(frame.plan), own = sheet.marks.map((m, n) => [m, n]).filter(([m]) => m.frame === frame.id && m.step);
    const label = frame.position || sheet.live?.find((l) => l.view === frame.view)?.position || (plan.positions[0] ?? "");
    const ids = [...new Set([...plan.steps.filter((id) => stepOf(id).helpers), ...own.map(([m]) => m.step)])];
    for (const id of ids.sort((a, b) => steps.get(a) - steps.get(b))) {
      const marks = own.filter(([m]) => m.step === id).map(([, n]) => n);
      const drawn = marks.some((n) => !sheet.marks[n].geometry.text);
      const helpers = at(stepOf(id).helpers, label) ?? [];
      if (drawn || (marks.length && helpers.length)) stops.push({ frame, label, id, marks, helpers });
    }
  }
  return stops;
}

function takeFilm(view = "") {
  pause();
  film.view = view;
  film.stops = stopsOf(leaf.sheet).filter((stop) => !view || stop.frame.view === view);
  film.at = -1;
  film.first = new Map();
  film.stops.forEach((stop, n) => stop.marks.forEach((mark) => { if (!film.first.has(mark)) film.first.set(mark, n); }));
  const scrub = $("scrub");
  scrub.max = film.stops.length;
  scrub.value = 0;
  countStops();
}

function countStops() {
  $("count").textContent = `${film.at + 1} / ${film.stops.length}`;
  $("scrub").setAttribute("aria-valuetext", `${film.at + 1} / ${film.stops.length}`);
}

const onPaper = (frame, [x, y]) => {
  const w = [x / frame.mu[0], (frame.mirror ? -1 : 1) * y / frame.mu[1]], z = mul(cis(frame.turn), w);
  return [frame.origin[0] + z[0], leaf.height - frame.origin[1] - z[1]];
};

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

function svgNode(name, attributes) {
  const found = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  return found;
}

function reveal(n) {
  const now = film.stops[n], args = new Set(now ? stepOf(now.id).args.map((a) => a.step) : []);
  leaf.sheet.marks.forEach((mark, i) => {
    const list = leaf.elements[i].classList, first = film.first.get(i);
    list.remove("now", "kin", "after", "other", "past", "later");
    if (first === undefined) list.add(film.view && mark.view !== film.view ? "later" : "past");
    else if (first > n) list.add("later");
    else if (first === n) { if (!mark.position || mark.position === now.label) list.add("now"); }
    else if (now && args.has(mark.step) && mark.frame === now.frame.id && (!mark.position || mark.position === now.label)) list.add("kin");
  });
  $("sheet").classList.remove("asked");
  $("sheet").classList.add("film");
}

// Draw one stop; resolves when the hand has done.
function drawStop(n, quick = still()) {
  const was = film.stops[film.at], stop = film.stops[n], hand = $("hand");
  film.at = n;
  $("scrub").value = n + 1;
  countStops();
  hand.replaceChildren();
  if (!stop) { dim(); reveal(-1); invite(); return Promise.resolve(); }
  reveal(n);
  asked.label = stop.label;
  $("panel").replaceChildren(...tellStep(stop.id, stop.label), tellWhy(stop.id, stop.label));
  if (!was || was.frame !== stop.frame) fitBox(boundsOf(leaf.sheet.marks.filter((m) => m.frame === stop.frame.id)));
  const strokes = stop.helpers.map((h) => strokeOf(h, stop.frame)).filter(Boolean);
  if (!strokes.length) {
    for (const mark of stop.marks) {
      const g = leaf.sheet.marks[mark].geometry;
      if (g.line || g.polyline || g.arc || g.circle) strokes.push({ d: pathOf(g, leaf.height) });
    }
  }
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

function showPlaying() {
  const button = $("play");
  if (!button) return;
  button.textContent = film.playing ? "❚❚" : "▶";
  button.setAttribute("aria-label", say(film.playing ? "pause" : "play"));
}

function stepTo(n, quick = false) {
  pause();
  drawStop(clip(n, -1, film.stops.length - 1), quick || still());
}

// Views of the sheet, each to be looked at and played by itself.
function viewList() {
  const names = [...new Set(stopsOf(leaf.sheet).map((stop) => stop.frame.view))];
  return node("div", {}, node("h3", {}, say("views of this sheet")), node("div", { class: "chips" }, ...names.map((name) => node("button", {
    type: "button", class: "chip", onclick: () => { takeFilm(name); $("what").value = name; fitBox(boundsOf(leaf.sheet.marks.filter((m) => m.view === name))); play(); } }, calledView(name)))));
}

function playerBar() {
  const back = node("button", { type: "button", "aria-label": say("step back"), title: say("step back"), onclick: () => stepTo(film.at - 1, true) }, "‹");
  const next = node("button", { type: "button", "aria-label": say("step"), title: say("step"), onclick: () => stepTo(film.at + 1) }, "›");
  const start = node("button", { type: "button", id: "play", class: "play", onclick: () => (film.playing ? pause() : play()) }, "▶");
  const scrub = node("input", { type: "range", id: "scrub", class: "scrub", min: 0, value: 0, "aria-label": say("steps"), oninput: () => stepTo(Number($("scrub").value) - 1, true) });
  const speed = node("select", { "aria-label": say("speed"), onchange: (event) => { film.speed = Number(event.target.value); } },
    ...[0.5, 1, 2, 4].map((s) => node("option", { value: s, selected: s === 1 }, `×${String(s).replace(".", decimal())}`)));
  const what = node("select", { id: "what", "aria-label": say("what is played"), onchange: (event) => { takeFilm(event.target.value); drawStop(-1); fit(); } });
  return [back, start, next, scrub, node("span", { class: "count", id: "count" }), what, speed];
}

function listFilms() {
  const names = [...new Set(stopsOf(leaf.sheet).map((stop) => stop.frame.view))];
  $("what")?.replaceChildren(node("option", { value: "" }, say("the whole sheet")), ...names.map((name) => node("option", { value: name }, calledView(name))));
}
