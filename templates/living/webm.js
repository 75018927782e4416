// The film of a lesson as WebM, by the browser itself: stop by stop, each drawn before one's eyes and left to be read. Each picture of it
// is put on a canvas and has its own time in the film, however long it took to make it.

const FRAMES = 12; // pictures of a film in a second

async function recordLesson() {
  const { width, height } = $("lesson").getBoundingClientRect(), part = Math.min(1280 / width, 1), even = (x) => 2 * Math.round(x * part / 2);
  const canvas = node("canvas", { width: even(width), height: even(height) }), pen = canvas.getContext("2d"), img = new Image();
  const head = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" style="font-size: ${getComputedStyle(document.documentElement).fontSize}"><style>${plain(document.querySelector("style").textContent)}</style>`
    + `<foreignObject width="100%" height="100%"><main xmlns="http://www.w3.org/1999/xhtml" class="${document.body.className}" style="height: 100%; color: var(--ink); background: var(--ground)">`;
  const made = new WEBM.Muxer({ target: new WEBM.ArrayBufferTarget(), video: { codec: "V_VP8", width: canvas.width, height: canvas.height } });
  const encoder = new VideoEncoder({ error: console.error, output: (chunk, told) => made.addVideoChunk(chunk, told) });
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
      const first = isNothing(stopNow()) ? drawing : 0;
      for (let k = first; k <= drawing; k++) {
        drawLesson(k / drawing);
        await take(n * STOP_MS + (k - first) * 1000 / FRAMES, !k || k === drawing);
      }
    }
    await take(all * STOP_MS - 1000 / FRAMES, false);
    await encoder.flush();
    made.finalize();
    download(`${lesson.told.plan}.webm`, made.target.buffer, "video/webm");
  } finally {
    document.body.inert = false;
    encoder.close();
  }
}
