// Words and nodes.

export const $ = /** @type {(id: string) => any} */ ((id) => document.getElementById(id));

let words = {};
export const speak = (found) => { words = found; };
export const say = (key, values = {}) => (words[key] ?? key).replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);

export function node(name, attributes = {}, ...inside) {
  const found = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) found.addEventListener(key.slice(2), value);
    else if (key.startsWith(".")) found[key.slice(1)] = value; // a property
    else if (value !== false && value !== undefined && value !== null) found.setAttribute(key, value === true ? "" : value);
  }
  found.append(...inside.flat().filter((one) => one || one === ""));
  return found;
}

export const button = (text, act, attributes = {}) => node("button", { type: "button", ...attributes, onclick: act }, text);

// A list to choose from, of pairs of a value and its text.
export const choice = (key, options, chosen, act, more = {}) => node("select", { "aria-label": say(key), ...more, onchange: (event) => act(event.target.value) },
  ...options.map(([value, text]) => node("option", { value, selected: value === chosen }, text)));

// A picture from its bytes; the one it takes the place of is let go.
export function picture(img, data, type = "image/svg+xml") {
  if (img.src.startsWith("blob:")) URL.revokeObjectURL(img.src);
  img.src = URL.createObjectURL(new Blob([data], { type }));
  return img;
}

export const bytesOf = (packed) => Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));

export function download(name, data, type = "application/octet-stream") {
  const link = node("a", { download: name, href: URL.createObjectURL(new Blob([data], { type })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// A place where files are dropped or chosen; `folder` takes a whole one.
export function dropZone(text, accept, take, folder = false) {
  const input = node("input", { type: "file", accept, webkitdirectory: folder, onchange: () => { if (input.files.length) take([...input.files]); input.value = ""; } });
  const zone = node("label", { class: "drop" }, text, input);
  for (const kind of ["dragenter", "dragover"]) zone.addEventListener(kind, (event) => { event.preventDefault(); zone.classList.add("over"); });
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", async (event) => {
    event.preventDefault();
    zone.classList.remove("over");
    const found = await dropped(event.dataTransfer);
    if (found.length) take(found);
  });
  return zone;
}

// Files of an entry that was dropped, those in folders too, each with its path.
async function filesOf(entry, path = "") {
  const told = (ask) => new Promise((done, fail) => { ask(done, fail); });
  if (entry.isFile) return [Object.assign(await told((done, fail) => entry.file(done, fail)), { path: path + entry.name })];
  const reader = entry.createReader(), found = [];
  for (let some; (some = await told((done, fail) => reader.readEntries(done, fail))).length;) for (const one of some) found.push(...await filesOf(one, `${path}${entry.name}/`));
  return found;
}

async function dropped(data) {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  return entries.length ? (await Promise.all(entries.map((one) => filesOf(one)))).flat() : [...data.files];
}

// Pictures of what takes some time, by the share of it that is over; a later one of the same owner takes its place.
export function animate(owner, ms, picture, then = () => {}) {
  cancelAnimationFrame(owner.moving);
  const start = performance.now(), frame = (now) => {
    const t = ms ? Math.min(Math.max((now - start) / ms, 0), 1) : 1;
    picture(t);
    if (t < 1) owner.moving = requestAnimationFrame(frame); else then();
  };
  frame(start);
}

export const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
