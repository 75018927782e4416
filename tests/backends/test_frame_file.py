"""The frame of DXF files that lies in templates/ is the one ezdxf writes; other paper has its own."""

import json
import subprocess
import sys

from ezdxf.lldxf.const import VALID_DXF_LINEWEIGHTS

from tests.backends.frame_file import FILE, text
from tmm_sheets.backends import dxf, dxf_frame, dxf_frame_making


def test_the_file_is_what_ezdxf_writes():
    assert FILE.read_text(encoding="utf-8") == text(), "python -m tests.backends.frame_file writes it"


def test_frame_comes_from_the_file_without_ezdxf():
    code = "import sys; from tmm_sheets.backends import dxf; dxf.frame(841.0, 594.0); sys.exit('ezdxf' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=60).returncode == 0
    assert dxf.frame(841.0, 594.0)._asdict() == json.loads(FILE.read_text(encoding="utf-8"))["frame"]


def test_other_paper_has_its_own_frame():
    found = dxf.frame(420.0, 297.0)
    assert found == dxf_frame_making.made(420.0, 297.0)
    assert "297" in found.text
    assert found.text != dxf.frame(841.0, 594.0).text


def test_other_line_types_have_their_own_frame(monkeypatch):
    kept = dxf.line_types()
    other = {**kept, "wave": next(iter(kept.values())).__class__("wave", 0.3, "WAVE", pattern=(7.0, -1.0), linetype="TMM_WAVE")}
    for module in (dxf, dxf_frame_making):
        monkeypatch.setattr(module, "line_types", lambda: other)
    assert "TMM_WAVE" in dxf.frame.__wrapped__(841.0, 594.0).text


def test_weights_are_those_of_ezdxf():
    assert dxf_frame.WEIGHTS == VALID_DXF_LINEWEIGHTS
