"""PDFs whose forms hold themselves or grow by tens at each level end with a sentence, within their time and memory."""

import os
import subprocess
import sys
from pathlib import Path
from time import monotonic

import pytest

from tests.few import few
from tmm_sheets import apart
from tmm_sheets.compare.photo import pdf_page, photograph
from tmm_sheets.errors import BadInput, CannotBuild

pytest.importorskip("pypdfium2")
ROOT = Path(__file__).parents[2]
A1 = "/MediaBox [0 0 2384 1684]"


def pdf(forms, page="/F0 Do"):
    """A page that draws form 0; ``forms`` are pairs of content and resources."""
    objects = ["<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
               f"<< /Type /Page /Parent 2 0 R {A1} /Contents 4 0 R /Resources << /XObject << /F0 5 0 R >> >> >>",
               f"<< /Length {len(page)} >>\nstream\n{page}\nendstream"]
    for content, inside in forms:
        objects.append(f"<< /Type /XObject /Subtype /Form /BBox [0 0 2384 1684] /Length {len(content)} "
                       f"/Resources << /XObject << {inside} >> >> >>\nstream\n{content}\nendstream")
    out, places = "%PDF-1.4\n", []
    for n, text in enumerate(objects, 1):
        places.append(len(out))
        out += f"{n} 0 obj\n{text}\nendobj\n"
    start = len(out)
    out += f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n" + "".join(f"{at:010} 00000 n \n" for at in places)
    return (out + f"trailer << /Size {len(objects) + 1} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n").encode()


def bomb(levels, each):
    """Each form draws the next one so many times; the last one a line."""
    forms = [("/F1 Do " * each, f"/F1 {6 + k} 0 R") for k in range(levels)]
    return pdf([*forms, ("0 0 m 2384 1684 l S", "")])


FILES = {"loop": pdf([("/F1 Do", "/F1 5 0 R")]), "two forms in a loop": pdf([("/F1 Do", "/F1 6 0 R"), ("/F1 Do", "/F1 5 0 R")]),
         "bomb": bomb(9, 20), "wide bomb": bomb(3, 2000)}


@pytest.mark.parametrize("name", few(FILES, "two forms in a loop"))
def test_it_ends_with_a_sentence(name, tmp_path):
    (tmp_path / "x.pdf").write_bytes(FILES[name])
    program = ("import resource, sys; from tmm_sheets.__main__ import run; status = run(sys.argv[1:]); "
               "own = next(int(x.split()[1]) for x in open('/proc/self/status') if x.startswith('VmHWM')); "
               "use = max(own, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); "
               "print(use, file=sys.stderr); sys.exit(status)")
    begun = monotonic()
    done = subprocess.run([sys.executable, "-c", program, "compare", "lugansk/cam_flat", "--sheet", "1", "--image", "x.pdf"],
                          cwd=tmp_path, capture_output=True, text=True, timeout=90, check=False,
                          env={**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1", "LANGUAGE": "en"})
    *said, use = done.stderr.splitlines()
    assert done.returncode in (1, 2), done.stderr
    assert said[0].startswith("x.pdf")
    assert "internal error" not in done.stderr
    assert int(use) < 1_000_000  # kilobytes
    assert monotonic() - begun < apart.SECONDS + 30  # of a busy machine


def test_a_bomb_is_told_as_one(tmp_path):
    (tmp_path / "x.pdf").write_bytes(FILES["bomb"])
    with pytest.raises(CannotBuild, match=r"x\.pdf: reading it takes more than 3 s or 1 GB\n    less"):
        apart.carried_out(photograph.read, tmp_path / "x.pdf", "less", seconds=3)


def test_a_page_is_drawn(tmp_path):
    """A line across an A1 page, in grey and of the size asked for."""
    made, pixels = pdf_page.drawn(pdf([("10 w 0 0 m 2384 1684 l S", "")]), 50.0, 400_000_000, 1e5)
    assert (made["kind"], made["pages"]) == ("page", 1)
    assert (made["width"], made["height"]) == (pytest.approx(2384 * 50 / 72, abs=1), pytest.approx(1684 * 50 / 72, abs=1))
    middle = pixels[made["height"] // 2 * made["stride"]:][: made["width"] * made["channels"]]
    assert 0.4 < middle.index(min(middle)) / len(middle) < 0.6
    assert pdf_page.drawn(b"%PDF-1.4 rubbish", 50.0, 10, 10)[0]["kind"] == "unreadable"


def test_a_page_that_is_none_is_told(tmp_path):
    (tmp_path / "x.pdf").write_bytes(pdf([("0 0 m 9 9 l S", "")]).replace(b"/Kids [", b"/Kids [9 0 R "))
    with pytest.raises(BadInput, match=r"x\.pdf: is not a PDF that can be read: Failed to load page"):
        photograph.read(tmp_path / "x.pdf")
