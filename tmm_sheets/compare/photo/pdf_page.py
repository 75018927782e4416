"""The first page of a PDF as pixels, drawn by a process of its own: the file costs no more time and memory than that may have.

A PDF may hold forms that hold forms, by tens at each level: a few kilobytes then cost hours, or gigabytes before the library aborts
its whole process. :func:`drawn` is what the program calls; run as a script this file is that process, which needs nothing but
pypdfium2: the document comes on standard input, a line of JSON and the pixels go to standard output.
"""

from __future__ import annotations

import json
import subprocess
import sys
from math import isfinite
from typing import Any

SECONDS = 15
"""Time that a page is given: a scan of an A1 sheet takes two."""
MEMORY = 800_000_000
"""Bytes that the process may have."""


class NotDrawn(Exception):
    """The process did not come to an end, or came to another one than was hoped for."""


def drawn(data: bytes, dpi: float, most: int, few: float) -> tuple[dict[str, Any], bytes]:
    """What there is to be told of a document, and the pixels of its first page in grey, row by row.

    ``dpi`` is what it is drawn with where that makes no less than ``few`` pixels; an image in it may have ``most``. The first says
    in ``kind`` what came of it: "page", or what is wrong, see :func:`_answer`.

    Raises
    ------
    NotDrawn
        when that takes more time or memory than it may.
    """
    command = [sys.executable, "-P", __file__, str(dpi), str(most), str(few)]
    try:
        done = subprocess.run(command, input=data, capture_output=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired as e:
        raise NotDrawn from e
    head, _, pixels = done.stdout.partition(b"\n")
    try:
        told: dict[str, Any] = json.loads(head)
    except ValueError:
        raise NotDrawn(done.stderr.decode(errors="replace")[-200:]) from None
    if done.returncode:
        raise NotDrawn
    return told, pixels


def _limit() -> None:
    """Keep this process within its memory and time, where the system can."""
    try:
        import resource
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _answer(data: bytes, dpi: float, most: int, few: float) -> tuple[dict[str, Any], bytes]:
    import pypdfium2

    try:
        document = pypdfium2.PdfDocument(data)
    except pypdfium2.PdfiumError as e:
        return {"kind": "locked" if "password" in str(e).lower() else "unreadable", "why": str(e)}, b""
    pages = len(document)
    if not pages:
        return {"kind": "empty"}, b""
    page = document[0]
    width, height = page.get_size()
    if not (isfinite(width) and isfinite(height) and 0 < max(width, height) <= 5 * min(width, height)):
        return {"kind": "shape", "width": width, "height": height}, b""
    for image in page.get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_IMAGE]):
        try:
            across, down = image.get_px_size()
        except pypdfium2.PdfiumError:
            continue
        if across * down > most:  # shrunk when the page is drawn, but decoded before
            return {"kind": "large", "width": across, "height": down}, b""
    scale = min(dpi / 72, (0.5 * most / max(width * height, 1.0)) ** 0.5)
    # Scans are often put on a page of another size than the paper's: as many pixels as A1 has at this resolution then.
    scale = max(scale, (few / max(width * height, 1.0)) ** 0.5)
    bitmap = page.render(scale=scale, grayscale=True)
    told = {"kind": "page", "pages": pages, "width": bitmap.width, "height": bitmap.height, "stride": bitmap.stride,
            "channels": bitmap.n_channels}
    return told, bytes(bitmap.buffer)


def _main() -> None:
    _limit()
    told, pixels = _answer(sys.stdin.buffer.read(), float(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
    sys.stdout.buffer.write(json.dumps(told).encode() + b"\n" + pixels)
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    _main()
