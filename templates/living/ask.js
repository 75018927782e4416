// A click on a mark: the step that made it, what it is made of, what follows from it.

const asked = { id: null, label: "" };

function light(id, label) {
  const kin = new Set(chain(id)), after = new Set(), pending = [id];
  while (pending.length) for (const one of children.get(pending.pop()) ?? []) if (!after.has(one)) { after.add(one); pending.push(one); }
  leaf.sheet.marks.forEach((mark, n) => {
    const here = !mark.position || !label || mark.position === label, s = mark.step;
    const what = !s || !here ? "other" : s === id ? "now" : kin.has(s) ? "kin" : after.has(s) ? "after" : "other";
    const list = leaf.elements[n].classList;
    list.remove("now", "kin", "after", "other", "past", "later");
    list.add(mark.role === "frame" ? "past" : what);
  });
}

function dim() {
  for (const element of leaf.elements) element.classList.remove("now", "kin", "after", "other", "past", "later");
  $("sheet").classList.remove("film", "asked");
  $("hand").replaceChildren();
}

function ask(id, when = asked.label) {
  if (!stepOf(id)) return;
  pause();
  const moving = !$("stage").hidden;
  if (moving) when = machine.phi; else showAsked(id, when);
  $("panel").replaceChildren(node("button", { type: "button", class: "chip", onclick: () => (moving ? openTab("turn") : unask()) }, say("back")), ...tellStep(id, when), tellWhy(id, when));
  $("panel").scrollTop = 0;
}

function showAsked(id, label) {
  Object.assign(asked, { id, label });
  const shows = (sheet) => sheet.marks.some((mark) => mark.step === id);
  const other = !shows(leaf.sheet) && record.sheets.find(shows);
  if (other) openSheet(other.sheet, true);
  $("sheet").classList.remove("film");
  $("sheet").classList.add("asked");
  $("hand").replaceChildren();
  light(id, label);
  const own = leaf.sheet.marks.filter((m) => m.step === id && (!m.position || !label || m.position === label));
  if (other && own.length) fitBox(boundsOf(own), 60);
}

function unask() {
  asked.id = null;
  dim();
  invite();
}

function invite() {
  $("panel").replaceChildren(node("h2", {}, record.words["how to"]), ...["play it", "click a line", ...(record.motion ? ["turn the crank"] : [])].map((key) =>
    node("p", { class: "hint" }, say(key))), viewList());
}

function clicked({ p, pixel }) {
  const n = markAt(p, 9 * pixel);
  if (n < 0) { unask(); return; }
  const mark = leaf.sheet.marks[n];
  ask(mark.step, mark.position ?? asked.label);
}

// Names of steps and results, found by what is typed.
function watchFind() {
  const box = $("find"), found = new Map();
  box.placeholder = say("find");
  box.setAttribute("aria-label", say("find"));
  for (const [id, s] of Object.entries(record.steps)) if (record.sheets.some((sheet) => sheet.plans.has(s.plan))) found.set(id, [id, ""]);
  for (const [path, result] of Object.entries(record.results)) found.set(path, [result.step, result.at?.[0] ?? ""]);
  $("names").innerHTML = [...found.keys()].map((name) => `<option value="${plain(name)}">`).join("");
  box.addEventListener("change", () => {
    const text = box.value.trim(), key = found.has(text) ? text : [...found.keys()].find((name) => name.toLowerCase().includes(text.toLowerCase()));
    if (!text) return;
    if (!key) { $("panel").hidden = false; $("panel").replaceChildren(node("h2", { role: "status" }, say("nothing found")), node("p", { class: "hint" }, text)); return; }
    openTab("draw");
    ask(...found.get(key));
  });
}
