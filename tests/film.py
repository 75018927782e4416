"""`make film`: the shaper and its velocity polygon through a turn of the crank, as an animated SVG in templates/pictures."""

import numpy as np

from tmm_sheets import catalogue
from tmm_sheets.living.page import hung, motion, recording
from tmm_sheets.project import Project
from tmm_sheets.resources import template

MOMENTS = 60
SECONDS = 6
SHOWN = {"positions": "link", "velocities": "vector"}
LEFT = {"positions": 0.0, "velocities": 190.0}
GROUND = "#ffffff"


def film(name="lugansk/shaper"):
    """Text of the film: a path for each link and vector, through all its places."""
    project = Project(catalogue.read(name))
    record, _ = recording.record(project, [1])
    known = motion(project, recording.book_of(project)).programs["all"].source.results
    turned = np.linspace(0, project.cycle.period, MOMENTS + 1)
    study = project.study_at(turned, tuple(map(str, range(len(turned)))))
    _ = study.positions, study.velocities
    values = {step.path: np.broadcast_to(step.value, turned.shape) for plan in study.plans.values() for step in plan
              if np.iscomplexobj(step.value)}
    paths, boxes = [], {}
    for view in hung(record, record["sheets"][0], known):
        role = SHOWN.get(view["plan"], "")
        seen = set()
        lines = []
        for mark in view["marks"]:
            ends = tuple(mark["along"]) if mark["kind"] == "line" and mark["role"] == role else ()
            if len(ends) == 2 and ends not in seen and all(end in values for end in ends):
                seen.add(ends)
                lines.append([values[end] / mark["mu"][0] for end in ends])
        if len(lines) > len(boxes.get(view["plan"], ())):  # in a dead position there are fewer
            boxes[view["plan"]] = lines
    for plan, lines in boxes.items():
        every = np.array(lines)
        size = 170 / max(np.ptp(every.real), np.ptp(every.imag))
        x0, y1 = every.real.min(), every.imag.max()
        for a, b in lines:
            places = [[f"{LEFT[plan] + 10 + (z.real - x0) * size:.1f} {10 + (y1 - z.imag) * size:.1f}" for z in end]
                      for end in (a, b)]
            steps = [f"M{p}L{q}m-1.5 0a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0-3 0" for p, q in zip(*places, strict=True)]
            paths.append(f'<path d="{steps[0]}" class="{plan}"><animate attributeName="d" dur="{SECONDS}s" '
                         f'repeatCount="indefinite" values="{";".join(steps)}"/></path>')
    style = ("path{fill:none;stroke:#1b1f24;stroke-width:2.2;stroke-linecap:round}"
             ".velocities{stroke:#c2410c;stroke-width:1.4}")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 380 190" width="760" height="380"><style>{style}</style>'
            f'<rect width="380" height="190" fill="{GROUND}"/>' + "".join(paths) + "</svg>\n")


if __name__ == "__main__":
    template("pictures/film.svg").write_text(film(), encoding="utf-8")
