// The page: its tabs, its keys, and what tests ask.

function selectTab(name) {
  for (const one of $("tabs").children) one.setAttribute("aria-selected", String(one.dataset.tab === String(name)));
  $("tabs").querySelector("[aria-selected=true]").scrollIntoView({ inline: "nearest", block: "nearest" });
}

function openSheet(number, quick = false) {
  const sheet = record.sheets.find((s) => s.sheet === number) ?? record.sheets[0];
  drawSheet(sheet);
  selectTab(sheet.sheet);
  listFilms();
  takeFilm();
  fit(quick);
}

// What each tab has of its own: its bar, who follows the crank, what is done to open and to print it. In motion the seen angle comes
// first, the whole turn with its scales and paths when the hand rests.
const TABS = {
  draw: { place: "paper", bar: playerBar, follows: drawPointers, print: () => fit(true), open: (sheet) => { openSheet(sheet ?? leaf.sheet.sheet, true); unask(); showPlaying(); } },
  turn: { place: "stage", bar: stageBar, print: () => stage.cards.forEach((card) => drawCard(card, parts(machine.phi))),
    follows: (changed) => { if (changed) { clearTimeout(stage.rests); stage.rests = setTimeout(() => { machine.found = machine.now = null; openStage(); }, REST_MS); } drawStage(); writeAddress(); },
    open: () => { $("panel").replaceChildren(...changePanel()); showEdits(); openStage(); } },
  lesson: { place: "lesson", bar: lessonBar, follows: () => { forgetGuess(); showStop(true); }, print: handOut, open: (plan, at) => openLesson(plan, at) },
};

// A tab: "draw" with the number of a sheet, "turn", or the "lesson" of a plan from one of its stops on.
function openTab(name, which, at) {
  pause();
  spin(false);
  playLesson(false);
  for (const one of Object.values(TABS)) $(one.place).hidden = one !== TABS[name];
  $("panel").hidden = name === "lesson";
  document.body.classList.toggle("teaching", name === "lesson");
  $("bar").replaceChildren(...TABS[name].bar());
  machine.watchers = [showAngle, TABS[name].follows];
  if (name !== "draw") selectTab(name);
  TABS[name].open(which, at);
  showAngle();
  writeAddress(true);
}

function onKey(event) {
  if (event.target.matches("input:not([type=range]), select, textarea") || event.ctrlKey || event.metaKey || event.altKey) {
    if ((event.ctrlKey || event.metaKey) && event.key === "z" && !$("stage").hidden) { event.preventDefault(); (event.shiftKey ? redo : undo)(); }
    return;
  }
  const moving = !$("stage").hidden, degree = Math.PI / 180;
  const acts = !$("lesson").hidden ? lessonKeys() : moving
    ? { " ": () => spin(!stage.playing), ArrowRight: () => turn(machine.phi + record.motion.sense * degree), ArrowLeft: () => turn(machine.phi - record.motion.sense * degree),
      Home: () => turn(record.motion.start) }
    : { " ": () => (film.playing ? pause() : play()), ArrowRight: () => stepTo(film.at + 1), ArrowLeft: () => stepTo(film.at - 1, true),
      Home: () => stepTo(-1, true), End: () => stepTo(film.stops.length - 1, true), "+": () => leaf.zoom.by(4 / 3), "=": () => leaf.zoom.by(4 / 3), "-": () => leaf.zoom.by(0.75),
      0: () => fit(), Escape: () => unask() };
  acts["?"] = () => $($("panel").hidden ? "told" : "panel").replaceChildren(node("h2", {}, say("keys")), node("p", { class: "hint", style: "white-space: pre-line" }, say("list of keys")));
  if (event.target.matches("button") && [" ", "Enter"].includes(event.key)) return;
  if (event.target.matches("input[type=range]") && event.key.startsWith("Arrow")) return;
  if (acts[event.key]) { event.preventDefault(); acts[event.key](); }
}

async function start() {
  takeRecord(await unpacked($("record").textContent));
  $("record").remove();
  for (const sheet of record.sheets) sheet.plans = new Set(sheet.frames.map((f) => f.plan));
  startMachine();
  const tab = (name, text, act) => button(text, act, { role: "tab", "data-tab": name });
  $("tabs").append(...record.sheets.map((s) => tab(s.sheet, say("sheet {n}", { n: s.sheet }), () => openTab("draw", s.sheet))));
  if (record.motion && record.sheets.some((s) => s.live?.length)) $("tabs").append(tab("turn", say("in motion"), () => openTab("turn")));
  if (record.lessons?.length) $("tabs").append(tab("lesson", say("lesson"), () => openTab("lesson", lesson.told?.plan ?? (record.lessons[1] ?? record.lessons[0]).plan, lesson.at)));
  $("turner").append(spinner("⟳", "turn the crank on the sheet"), angleSlider());
  leaf.zoom = zoomable($("sheet"), ({ x, y, w, h }) => $("sheet").setAttribute("viewBox", `${x} ${y} ${w} ${h}`), clicked);
  $("zoom").append(...leaf.zoom.tools);
  setTimeout(watchFind);
  const shown = record.sheets.flatMap((s) => s.live ?? []).find((one) => one.plan === "positions"), plan = planOf("positions");
  machine.phi = plan?.phi?.[plan.positions.indexOf(shown?.position)] ?? record.motion?.start ?? 0;
  const opens = record.opens && record.sheets.find((s) => s.plans.has(record.opens));
  leaf.sheet = opens || record.sheets[0];
  const told = location.hash.length > 1;
  if (!told || !readAddress()) openTab("draw", leaf.sheet.sheet);
  addEventListener("hashchange", () => { if (location.hash !== address.written) readAddress(); });
  if (opens && !told) openView(opens.frames.find((f) => f.plan === record.opens).view);
  document.addEventListener("keydown", onKey);
  new ResizeObserver(() => drawLesson()).observe($("pair"));
  addEventListener("beforeprint", () => Object.values(TABS).find((one) => !$(one.place).hidden).print());
  document.addEventListener("fullscreenchange", () => { if (!document.fullscreenElement && lesson.mode === "lecture") lessonMode("lecture"); });
  window.tmm = { at: valuesAt, set: setGiven, record, ready: true,
    film: () => film.stops.length, step: (n) => drawStop(n, true), views: () => stage.cards.length, open: openTab, turn, ask };
  document.documentElement.dataset.ready = "";
}

start();
