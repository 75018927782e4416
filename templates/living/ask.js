// A click on a mark: the step that made it, what it is made of, what follows from it.

const asked = { id: null, label: "" };

function light(id, label) {
  const kin = new Set(chain(id)), after = new Set(), pending = [id];
  while (pending.length) for (const one of children.get(pending.pop()) ?? []) if (!after.has(one)) { after.add(one); pending.push(one); }
  paint((mark) => {
    const here = !mark.position || !label || mark.position === label, s = mark.step;
    return mark.role === "frame" ? "past" : !s || !here ? "other" : s === id ? "now" : kin.has(s) ? "kin" : after.has(s) ? "after" : "other";
  });
}

// Each mark of the sheet as what it is beside the step that is told.
function paint(as) {
  leaf.sheet.marks.forEach((mark, n) => {
    const list = leaf.elements[n].classList, found = as(mark, n);
    list.remove("now", "kin", "after", "other", "past", "later");
    if (found) list.add(found);
  });
}

function dim() {
  paint(() => "");
  $("sheet").classList.remove("film", "asked");
  $("hand").replaceChildren();
}

function ask(id, when = /** @type {any} */ (asked.label)) {
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
    node("p", { class: "hint" }, say(key))), ...viewList());
}

const askMark = (mark) => ask(mark.step, mark.position ?? asked.label);

function clicked([x, y], pixel) {
  leaf.outlines ??= outlines(leaf.sheet.marks);
  const n = nearest(leaf.outlines, leaf.sheet.marks, [x, leaf.height - y], HIT * pixel);
  if (n < 0) unask(); else askMark(leaf.sheet.marks[n]);
}

const nameOf = (id) => `${called(stepOf(id))} · ${planOf(stepOf(id).plan).title}`;

// Marks by keyboard: from their drawing the arrows up and down go over the steps in sight, a mark of each; Enter picks one.
function byKeys(svg, elements, marks, pick) {
  const own = marks.flatMap((mark, n) => (stepOf(mark?.step) && !mark.geometry.text ? [[`${mark.step} ${mark.position}`, n]] : [])), stops = [...new Map(own.reverse()).values()].reverse();
  for (const n of stops) setAll(elements[n], { tabindex: -1, role: "button", "aria-label": [nameOf(marks[n].step), momentOf(marks[n].position)].filter(Boolean).join(", ") });
  svg.onkeydown = (event) => {
    const frame = svg.getBoundingClientRect(), seen = (box) => box.right > frame.left && box.left < frame.right && box.bottom > frame.top && box.top < frame.bottom;
    const there = stops.filter((n) => elements[n].checkVisibility({ visibilityProperty: true }) && seen(elements[n].getBoundingClientRect()));
    const at = there.indexOf(elements.indexOf(event.target)), by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by) elements[there[clip(at + by, 0, there.length - 1)]]?.focus({ preventScroll: true });
    else if (at >= 0 && [" ", "Enter"].includes(event.key)) pick(marks[there[at]]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
}

// Steps and results, found by their names on the sheet with those of their plans, or by their ids.
function watchFind() {
  const box = $("find"), drawn = Object.entries(record.steps).filter(([, s]) => record.sheets.some((sheet) => sheet.plans.has(s.plan)));
  const all = [...drawn.map(([id]) => ({ name: nameOf(id), key: id, id, where: undefined })),
    ...Object.entries(record.results).map(([path, { step: id, at: where }]) => ({ name: path, key: path, id, where: where?.[0] }))];
  setAll(box, { placeholder: say("find"), "aria-label": say("find") });
  $("names").replaceChildren(...[...new Set(all.map((one) => one.name))].map((value) => node("option", { value })));
  box.addEventListener("change", () => {
    const text = box.value.trim().toLowerCase(), test = (is) => all.find((one) => is(one.name.toLowerCase()) || is(one.key.toLowerCase()));
    if (!text) return;
    const hit = test((name) => name === text) ?? test((name) => name.startsWith(text)) ?? test((name) => name.includes(text));
    if (hit) { openTab("draw"); ask(hit.id, hit.where ?? ""); return; }
    $("panel").hidden = false;
    $("panel").replaceChildren(node("h2", { role: "status" }, say("nothing found")), node("p", { class: "hint" }, box.value));
  });
}
