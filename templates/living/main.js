// The page: its tabs, its keys, and what tests ask.

function openSheet(number, quick = false) {
  const sheet = record.sheets.find((s) => s.sheet === number) ?? record.sheets[0];
  drawSheet(sheet);
  for (const button of $("tabs").querySelectorAll("[data-sheet]")) button.setAttribute("aria-selected", String(Number(button.dataset.sheet) === sheet.sheet && !$("paper").hidden));
  listFilms();
  takeFilm();
  fit(quick);
}

// A tab: a sheet by its number, "turn", or the "lesson" of a plan from one of its stops on.
function openTab(name, which, at) {
  const moves = name === "turn", teaches = name === "lesson", sheet = teaches ? undefined : which;
  pause();
  spin(false);
  $("paper").hidden = moves || teaches;
  $("stage").hidden = !moves;
  $("lesson").hidden = !teaches;
  $("panel").hidden = teaches;
  document.body.classList.toggle("teaching", teaches);
  for (const button of $("tabs").children) button.setAttribute("aria-selected", String(name !== "draw" ? button.dataset.tab === name : Number(button.dataset.sheet) === (sheet ?? leaf.sheet.sheet)));
  $("bar").replaceChildren(...(teaches ? lessonBar() : moves ? stageBar() : playerBar()));
  if (teaches) {
    machine.watchers = [lessonTurned];
    openLesson(which, at);
  } else if (moves) {
    machine.watchers = [(name2) => { if (name2 && !$("stage").hidden) takeTurn(); drawStage(); writeAddress(); }];
    $("panel").replaceChildren(...changePanel());
    showEdits();
    openStage();
  } else {
    machine.watchers = [drawPointers];
    openSheet(sheet ?? leaf.sheet.sheet, true);
    unask();
    showPlaying();
  }
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
      Home: () => stepTo(-1, true), End: () => stepTo(film.stops.length - 1, true), "+": () => zoom(0.75), "=": () => zoom(0.75), "-": () => zoom(1 / 0.75),
      0: () => fit(), Escape: () => unask() };
  acts["?"] = () => alertKeys();
  if (event.target.matches("button") && event.key === " ") return;
  if (event.target.matches("input[type=range]") && event.key.startsWith("Arrow")) return;
  if (acts[event.key]) { event.preventDefault(); acts[event.key](); }
}

function alertKeys() {
  $("panel").replaceChildren(node("h2", {}, say("keys")), node("p", { class: "hint", style: "white-space: pre-line" }, say("list of keys")));
}

async function start() {
  const found = await unpacked($("record").textContent);
  $("record").remove();
  takeRecord(found);
  for (const sheet of record.sheets) sheet.plans = new Set(sheet.frames.map((f) => f.plan));
  startMachine();
  const tab = (attributes, text, act) => node("button", { type: "button", role: "tab", ...attributes, onclick: act }, text);
  $("tabs").append(...record.sheets.map((s) => tab({ "data-sheet": s.sheet }, say("sheet {n}", { n: s.sheet }), () => openTab("draw", s.sheet))));
  if (record.motion && record.sheets.some((s) => s.live?.length)) $("tabs").append(tab({ "data-tab": "turn" }, say("in motion"), () => openTab("turn")));
  if (record.lessons?.length) $("tabs").append(tab({ "data-tab": "lesson" }, say("lesson"), () => openTab("lesson", lesson.told?.plan ?? (record.lessons[1] ?? record.lessons[0]).plan, lesson.at)));
  makeTurner();
  watchViewport(clicked);
  setTimeout(watchFind);
  if (record.motion) machine.phi = phiOf(record.sheets.flatMap((s) => s.live ?? []).find((v) => v.plan === "positions"));
  const opens = record.opens && record.sheets.find((s) => s.plans.has(record.opens));
  leaf.sheet = opens || record.sheets[0];
  const told = location.hash.length > 1;
  if (!told || !readAddress()) openTab("draw", leaf.sheet.sheet);
  watchAddress();
  if (opens && !told) {
    const view2 = opens.frames.find((f) => f.plan === record.opens).view;
    takeFilm(view2);
    $("what").value = view2;
    fitBox(boundsOf(opens.marks.filter((m) => m.view === view2)));
  }
  document.addEventListener("keydown", onKey);
  window.tmm = { at: valuesAt, set: setGiven, record, ready: true,
    film: () => film.stops.length, step: (n) => drawStop(n, true), views: () => stage.cards.length, open: openTab, turn, ask };
  document.documentElement.dataset.ready = "";
}

// World angle of the position that a view is drawn for.
function phiOf(live) {
  const plan = live && planOf(live.plan), k = plan ? plan.positions.indexOf(live.position) : -1;
  return plan?.phi?.[k] ?? record.motion.start;
}

start();
