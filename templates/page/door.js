// The doors of the server: a request is a piece of work; whoever stops listening ends it.

import { say } from "./dom.js";

export const languages = { chosen: localStorage.getItem("lang") ?? "" };

export const told = async (door) => (await fetch(`${door}?lang=${languages.chosen}`)).json();

// Ask for work: `heard` is told what comes before the last message, which is given back. A problem is thrown.
export async function ask(door, fields, { heard = () => {}, signal, files = [] } = {}) {
  const form = new FormData();
  for (const [key, value] of Object.entries({ lang: languages.chosen, ...fields })) form.append(key, value ?? "");
  for (const file of files) form.append("file", file, file.path || file.webkitRelativePath || file.name);
  const answer = await fetch(door, { method: "POST", body: form, signal }).catch(unheard);
  if (!answer.ok) throw new Error(answer.status === 503 ? say("busy") : (await answer.text()).trim());
  for await (const line of lines(answer.body)) {
    const message = JSON.parse(line);
    if (message.done) return message.done;
    if (message.problem !== undefined) throw new Error(message.problem);
    heard(message);
  }
  throw new DOMException("", "AbortError");
}

function unheard(error) { throw aborted(error) ? error : new Error(say("no answer")); }

async function* lines(stream) {
  const reader = stream.pipeThrough(new TextDecoderStream()).getReader();
  let left = "";
  for (;;) {
    const { done, value } = await reader.read().catch(unheard);
    if (done) return;
    const parts = value.split("\n");
    parts[0] = left + parts[0];
    left = parts.pop();
    yield* parts;
  }
}

// One piece of work at a time: the next one ends it.
export function latest() {
  let running = null;
  return {
    begin() { running?.abort(); running = new AbortController(); return running.signal; },
    stop() { running?.abort(); running = null; },
  };
}

export const aborted = (error) => error.name === "AbortError";
