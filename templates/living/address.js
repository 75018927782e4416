// The state of the page in its address: #plan=accelerations&step=5&phi=126&crank.length=0.082, also of a page from a file.

const address = { written: "" };

function addressNow(changes = record.motion ? changed() : []) {
  const teaching = !$("lesson").hidden, moving = !$("stage").hidden;
  const place = teaching ? { plan: lesson.told.plan, step: lesson.at + 1, ...(lesson.mode === "show" ? {} : { mode: lesson.mode }) } : moving ? { tab: "motion" } : { sheet: leaf.sheet.sheet };
  const numbers = teaching || moving ? { phi: Number(mod(machine.phi * 180 / Math.PI, 360).toFixed(2)), ...Object.fromEntries(changes.map((g) => [g.name, machine.given[g.name]])) } : {};
  return `#${new URLSearchParams({ ...place, ...numbers })}`;
}

// A new place in the history for another view, the same one for another angle or step.
function writeAddress(anew = false) {
  clearTimeout(address.waits);
  const write = () => {
    const text = addressNow();
    if (parent !== window) parent.postMessage({ at: addressNow([]) }, "*"); // a page that shows this one opens the next one there
    if (text === location.hash) return;
    address.written = text;
    if (anew) location.hash = text; else history.replaceState(null, "", text);
  };
  if (anew) write(); else address.waits = setTimeout(write, 150);
}

function readAddress() {
  const found = new URLSearchParams(location.hash.slice(1));
  if (![...found.keys()].length) return false;
  if (record.motion) {
    const given = { ...machine.made };
    for (const g of record.motion.givens) if (found.has(g.name)) {
      const numbers = found.get(g.name).split(",").map(Number);
      if (numbers.every(Number.isFinite) && numbers.length === [g.value].flat().length) given[g.name] = Array.isArray(g.value) ? numbers : numbers[0];
    }
    machine.given = given;
    const phi = Number(found.get("phi"));
    if (found.has("phi") && Number.isFinite(phi)) machine.phi = phi * Math.PI / 180;
  }
  const plan = found.get("plan"), sheet = Number(found.get("sheet"));
  if (record.lessons?.some((one) => one.plan === plan)) {
    openTab("lesson", plan, (Number(found.get("step")) || 0) - 1);
    const mode = found.get("mode") ?? "show";
    if (mode !== lesson.mode && ["show", "lecture", "guess"].includes(mode)) lessonMode(mode === "show" ? lesson.mode : mode);
  } else if (found.get("tab") === "motion" && record.motion) openTab("turn");
  else openTab("draw", sheet || undefined);
  return true;
}

async function copyLink() {
  writeAddress();
  history.replaceState(null, "", addressNow());
  const said = node("div", { id: "toast", role: "status" });
  try { await navigator.clipboard.writeText(location.href); said.textContent = say("copied"); } catch { said.textContent = location.href; }
  document.body.append(said);
  setTimeout(() => said.remove(), 2600);
}
