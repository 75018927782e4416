"""The first page of a PDF as pixels.

A PDF may hold forms that hold forms, by tens at each level: a few kilobytes then cost hours, or gigabytes before the library aborts
its whole process. So it is drawn in a process of its own, as all pictures are read, see :mod:`~tmm_sheets.apart`.
"""

from __future__ import annotations

from math import isfinite
from typing import Any


def drawn(data: bytes, dpi: float, most: int, few: float) -> tuple[dict[str, Any], bytes]:
    """What there is to be told of a document, and the pixels of its first page in grey, row by row.

    ``dpi`` is what it is drawn with where that makes no less than ``few`` pixels; an image in it may have ``most``. The first says
    in ``kind`` what came of it: "page", or what is wrong.
    """
    import pypdfium2

    try:
        document = pypdfium2.PdfDocument(data)
        pages = len(document)
        page = document[0] if pages else None
    except pypdfium2.PdfiumError as e:
        return {"kind": "locked" if "password" in str(e).lower() else "unreadable", "why": str(e)}, b""
    if page is None:
        return {"kind": "empty"}, b""
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
