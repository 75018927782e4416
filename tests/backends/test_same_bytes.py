import os
import subprocess
import sys
from pathlib import Path

CODE = """
import hashlib, sys
sys.path.insert(0, sys.argv[1])
import numpy as np
from tmm_sheets.backends import dxf, hpgl, pdf, png, svg
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.drawing.paper import draw_frame
canvas = Canvas()
draw_frame(canvas, {"designation": "ТММ.КП", "title": "Лист"}, "1", 1, 4)
for i, style in enumerate(line_types()):
    canvas.line(30 + 10j * i, 300 + 20j * i, style)
    canvas.circle(300 + 300j, 10 + i, style)
canvas.dot(100 + 100j)
drawing = Drawing(841, 594, "Лист", tuple(canvas.marks), "Иванов")
for backend in (pdf, dxf, svg, png, hpgl):
    first = backend.render(drawing)
    assert first == backend.render(drawing)
    print(hashlib.sha256(first).hexdigest())
"""


def test_two_processes_write_the_same_bytes(tmp_path):
    script = tmp_path / "write.py"
    script.write_text(CODE, encoding="utf-8")
    root = str(Path(__file__).resolve().parents[2])
    outputs = set()
    for seed, zone in (("1", "UTC"), ("4", "Asia/Vladivostok")):
        env = os.environ | {"PYTHONHASHSEED": seed, "TZ": zone}
        done = subprocess.run([sys.executable, str(script), root], env=env, capture_output=True, text=True, check=True)
        outputs.add(done.stdout)
    assert len(outputs) == 1
    assert len(outputs.pop().split()) == 5
