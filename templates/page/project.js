// The project at hand: its name and text; whoever wants to know is told of changes. Recent ones are kept in the browser.

export const project = { name: "", text: "", watchers: [] };

const MOST = 8, LARGEST = 200000;

export const recent = () => JSON.parse(localStorage.getItem("recent") ?? "[]");

// Another text, from somewhere: "file", "editor", "living", "saved".
export function change(text, from, name = project.name) {
  project.name = name;
  project.text = text;
  if (text && text.length < LARGEST) localStorage.setItem("recent", JSON.stringify([{ name, text }, ...recent().filter((one) => one.name !== name)].slice(0, MOST)));
  for (const watcher of project.watchers) watcher(from);
}

// The text of a file in UTF-8, or as Windows wrote it.
export async function textOf(file) {
  const data = await file.arrayBuffer();
  try { return new TextDecoder("utf-8", { fatal: true }).decode(data); } catch { return new TextDecoder("windows-1251").decode(data); }
}
