// The film of a lesson as WebM, by the browser itself: each picture has its own time in the film, however long it took to make it.

const FRAMES = 12, CLOCK = 1e6; // pictures of a film in a second; microseconds in one, of an encoder; nanoseconds of a unit of WebM

const uint = (x) => new Uint8Array(Array.from({ length: 8 }, (_, n) => Math.floor(x / 256 ** (7 - n)) % 256));

// An element of Matroska: its id, the length of what it holds in eight bytes, what it holds.
function element(id, ...held) {
  const body = new Blob(held), length = uint(body.size);
  length[0] = 1;
  return new Blob([uint(id).filter((byte, n, all) => all.slice(0, n + 1).some(Boolean)), length, body]);
}

// The file of pictures of VP8, each with its time, ms, whether it is a whole one, and its bytes.
function webm(pictures, { width, height }, ms) {
  const float = new Uint8Array(8), clusters = [];
  new DataView(float.buffer).setFloat64(0, ms);
  for (const one of pictures) if (one.whole) clusters.push([one]); else clusters.at(-1).push(one);
  const block = ({ at, whole, bytes }, start) => element(0xa3, new Uint8Array([0x81, (at - start) >> 8, (at - start) & 255, whole ? 0x80 : 0]), bytes);
  return new Blob([
    element(0x1a45dfa3, element(0x4286, uint(1)), element(0x42f7, uint(1)), element(0x42f2, uint(4)), element(0x42f3, uint(8)), element(0x4282, "webm"), element(0x4287, uint(2)), element(0x4285, uint(2))),
    element(0x18538067, element(0x1549a966, element(0x2ad7b1, uint(CLOCK)), element(0x4489, float), element(0x4d80, "tmm-sheets"), element(0x5741, "tmm-sheets")),
      element(0x1654ae6b, element(0xae, element(0xd7, uint(1)), element(0x73c5, uint(1)), element(0x83, uint(1)), element(0x86, "V_VP8"), element(0xe0, element(0xb0, uint(width)), element(0xba, uint(height))))),
      ...clusters.map((own) => element(0x1f43b675, element(0xe7, uint(own[0].at)), ...own.map((one) => block(one, own[0].at))))),
  ], { type: "video/webm" });
}

// The lesson stop by stop: each is drawn before one's eyes and stays to be read. It is put on a canvas picture by picture.
async function recordLesson() {
  const { width, height } = $("lesson").getBoundingClientRect(), part = Math.min(1280 / width, 1), even = (x) => 2 * Math.round(x * part / 2);
  const canvas = node("canvas", { width: even(width), height: even(height) }), pen = canvas.getContext("2d"), img = new Image(), pictures = [];
  const head = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" style="font-size: ${getComputedStyle(document.documentElement).fontSize}"><style>${plain(document.querySelector("style").textContent)}</style>`
    + `<foreignObject width="100%" height="100%"><main xmlns="http://www.w3.org/1999/xhtml" class="${document.body.className}" style="height: 100%; color: var(--ink); background: var(--ground)">`;
  const encoder = new VideoEncoder({ error: console.error, output: (chunk) => {
    const bytes = new Uint8Array(chunk.byteLength);
    chunk.copyTo(bytes);
    pictures.push({ at: Math.round(chunk.timestamp / 1000), whole: chunk.type === "key", bytes });
  } });
  encoder.configure({ codec: "vp8", width: canvas.width, height: canvas.height, bitrate: 4e6 });
  const take = async (ms, keyFrame) => {
    img.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(head + new XMLSerializer().serializeToString($("lesson")) + "</main></foreignObject></svg>")}`;
    await img.decode();
    pen.drawImage(img, 0, 0, canvas.width, canvas.height);
    const frame = new VideoFrame(canvas, { timestamp: ms * 1000 });
    encoder.encode(frame, { keyFrame });
    frame.close();
  };
  const all = lesson.told.stops.length, drawing = Math.round(DRAWN_MS * FRAMES / 1000);
  document.body.inert = true; // what is pressed now would be in the film
  try {
    for (let n = 0; n < all; n++) {
      goStop(n, true, false);
      for (let k = isNothing(stopNow()) ? drawing : 0; k <= drawing; k++) {
        drawLesson(k / drawing);
        await take(n * STOP_MS + (pictures.length || k ? k * 1000 / FRAMES : 0), !k || k === drawing);
      }
    }
    await take(all * STOP_MS - 1000 / FRAMES, false);
    await encoder.flush();
    download(`${lesson.told.plan}.webm`, webm(pictures, canvas, all * STOP_MS), "video/webm");
  } finally {
    document.body.inert = false;
    encoder.close();
  }
}
