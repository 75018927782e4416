// The state of the page in its address: #plan=accelerations&step=5&phi=126&crank.length=0.082, also of a page from a file.

const address = { written: "" };

function addressNow(changes = record.motion ? changed() : []) {
  const teaching = !$("lesson").hidden, moving = !$("stage").hidden;
  const place = teaching ? { plan: lesson.told.plan, step: lesson.at + 1, ...(lesson.mode === "show" ? {} : { mode: lesson.mode }) } : moving ? { tab: "motion" } : { sheet: leaf.sheet.sheet };
  const numbers = teaching || moving ? { phi: Number(mod(machine.phi * 180 / Math.PI, 360).toFixed(2)), ...Object.fromEntries(changes.map((g) => [g.name, machine.given[g.name]])) } : {};
  return `#${new URLSearchParams(/** @type {any} */ ({ ...place, ...numbers }))}`;
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

// Whether another machine can open the address: that of a page from a file, of one's own machine, or inside another page it cannot.
const isPublic = () => /^https?:$/.test(location.protocol) && !/^(localhost|127\.|\[::1\])/.test(location.hostname) && parent === window;

// The address to the clipboard; where a phone can open it with a code to scan, until it is clicked.
async function copyLink() {
  writeAddress();
  history.replaceState(null, "", addressNow());
  const said = node("div", { id: "toast", role: "status", onclick: () => said.remove() }), copied = await navigator.clipboard?.writeText(location.href).then(() => say("copied"), () => "");
  said.append(node("p", {}, copied || location.href), isPublic() ? codeOf(location.href) : node("p", {}, say("no code")));
  $("toast")?.remove();
  document.body.append(said);
  if (!isPublic()) setTimeout(() => said.remove(), 5000);
}

// A text as a QR code.
function codeOf(text) {
  const code = QR.generate(text), places = Array.from({ length: code.size ** 2 }, (_, n) => [n % code.size, Math.floor(n / code.size)]), wide = code.size + 8;
  const found = svgNode("svg", { class: "code", viewBox: `-4 -4 ${wide} ${wide}`, role: "img", "aria-label": "QR" });
  found.append(svgNode("path", { fill: "#fff", d: `M-4-4h${wide}v${wide}h-${wide}z` }), svgNode("path", { fill: "#000", d: places.filter(([x, y]) => code.get(x, y)).map(([x, y]) => `M${x} ${y}h1.04v1.04h-1.04z`).join("") }));
  return found;
}
