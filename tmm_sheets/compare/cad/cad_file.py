"""Reading DXF files of any program, whole or damaged, text or binary.

Blocks, dimensions and leaders are exploded down to primitives. Layers that are off or frozen, invisible entities and the layer
Defpoints are left out. Points are complex, in drawing units, seen from above.
"""

from __future__ import annotations

import logging
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from io import BytesIO
from itertools import chain, islice, pairwise
from math import isfinite, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets import files
from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import (
    LETTER_WIDTH,
    Area,
    CadInk,
    DrawingSpace,
    DrawnStroke,
    Entity,
    Pattern,
    Writing,
    of_dashes,
)
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.ink import polyline_inside
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell, tell_n

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.entities.dxfentity import DXFEntity

UNITS = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 8: 25.4e-6, 9: 0.0254, 13: 1e-3, 14: 100.0}
"""Millimetres of $INSUNITS."""
FINE = 5e-6
"""Sagitta of flattened curves as a share of the drawing's diagonal (0.005 mm on an A1 sheet)."""
COARSEST = 1e-7
"""Least sagitta of a flattened curve in its own sizes: a circle that is vast beside the drawing still has 7000 chords at most."""
LARGEST = 64_000_000
"""Bytes of the largest file; a sheet has 0.1 to 20 million. Read, it takes ten times as much."""
MOST_PARTS, MOST_POINTS = 60_000, 4_000_000
"""Most primitives and points of a drawing with its blocks taken apart; a sheet with lettering in strokes has 30,000 and 200,000."""
DEEPEST = 20
"""Blocks within blocks."""
STRETCHED = 1e-3
"""Share by which a block is higher, or lower, than it is wide without being called stretched."""
MOST_NAMED = 3
"""Blocks that are named in a note."""
MOST_COPIES = 100
"""Lines in one and the same place that are looked at; programs leave two or three."""
FARTHEST = 1e100
"""Drawing units from the origin that coordinates have at most: of more no product is a number."""
MOST_HATCH = 20_000
"""Lines of one hatching that are drawn."""
UNREAD = {"3DSOLID", "BODY", "REGION", "SURFACE", "MESH", "IMAGE", "OLE2FRAME", "ACAD_PROXY_ENTITY", "PDFUNDERLAY", "WIPEOUT"}
CURVES = {"ARC", "CIRCLE", "ELLIPSE", "SPLINE"}
"""Entities flattened by themselves: with few Bezier curves a turn they would be off by 0.03 % of the radius."""
PRIMITIVE = {"LINE", "LWPOLYLINE", "CIRCLE", "ARC", "TEXT", "POLYLINE", "SPLINE", "SOLID", "HATCH", "MTEXT"}
AS_DXF = marked("save the drawing as DXF (AutoCAD: DXFOUT or Save as; KOMPAS: Save as, DXF)")
SMALLER = marked("save only the sheet itself: without other drawings, unused blocks purged, arrays and dense hatchings removed")
BINARY = b"AutoCAD Binary DXF"
"""How a binary DXF file begins."""
OTHERS = {b"%PDF": "PDF", b"\x89PNG": "PNG", b"\xff\xd8\xff": "JPEG", b"PK\x03\x04": "ZIP", b"KF\x1a": "KOMPAS"}
"""How files of other kinds begin that are taken for drawings."""
PICTURES = {"PDF", "PNG", "JPEG"}
BEGINNING = re.compile(r"(?:\{|\\[ACFHQTWcfp][^;\\{}]*;|\\[LOKlok])*")
HEIGHT = re.compile(r"\\H(\d*\.?\d+)(x?);")
"""Codes before the first letter of a text of several lines, and one of its height, or of that times so many."""
SILENT = {"POINT", "VIEWPORT", "ATTDEF", "RAY", "XLINE", "LIGHT", "SUN"}


def read(path: Path) -> CadInk:
    """Read a DXF file.

    Raises
    ------
    BadInput
        If there is no such file, or it is empty, a DWG or no DXF at all, or nothing is drawn in it.
    CannotBuild
        If the file, or what its blocks and curves come to, is too large.
    """
    document, notes = _open(path)
    unit = UNITS.get(int(document.header.get("$INSUNITS", 0)))
    reader = DxfReader(document, path)
    model = reader.space(tell("model space"), document.modelspace())
    spaces = [model, *(reader.paper(layout, model) for layout in document.layouts if not layout.is_modelspace)]
    notes += reader.notes()
    good = tuple(s for s in spaces if s.strokes)
    if not good:
        said = "; ".join(notes)
        what = tell("nothing is drawn in it ({notes})") if said else tell("nothing is drawn in it")
        raise BadInput(Problem(what.format(notes=said), str(path), hint=tell("save the drawing with its layers on and thawed")))
    return CadInk(good, unit, tuple(notes))


def _open(path: Path) -> tuple[Document, list[str]]:
    """The document, mended where it is damaged, and what is to be told of that."""
    from ezdxf import recover
    from ezdxf.filemanagement import readfile
    from ezdxf.lldxf.const import DXFError

    head = _head(path)
    _refuse_others(path, head)
    damage = (OSError, DXFError, ValueError, LookupError, TypeError, AttributeError, AssertionError, ArithmeticError, StopIteration,
              RecursionError)
    with _silent_library():
        try:
            try:  # most files need no repair, and binary ones cannot be repaired
                return readfile(path), []
            except damage:
                if head.startswith(BINARY):
                    raise
            whole = _completed(path.read_bytes())
            document, auditor = recover.readfile(path) if whole is None else recover.read(BytesIO(whole))
        except damage as e:
            said = tell("this is not a DXF file or it is damaged beyond repair ({why})").format(why=str(e) or type(e).__name__)
            raise BadInput(Problem(said, str(path), hint=tell(AS_DXF))) from None
    # Nearly every program writes something this library mends; only what was lost is worth a word.
    if whole is not None:
        return document, [tell("the file ends in the middle: what there is of it was compared")]
    lost = len(auditor.errors)
    if not lost:
        return document, [tell("the file was damaged and was mended")]
    return document, [tell_n("the file is damaged: {n} error could not be mended, part of it may be lost",
                             "the file is damaged: {n} errors could not be mended, part of it may be lost", lost).format(n=lost)]


def _head(path: Path) -> bytes:
    """How a file begins, if it is not too large."""
    try:
        files.check_file(path)
        size = path.stat().st_size
        if size > LARGEST:
            said = tell("{file}: {size} MB are more than can be handled ({most})")
            raise CannotBuild(said.format(file=path, size=round(size / 1e6), most=round(LARGEST / 1e6)), tell(SMALLER))
        with path.open("rb") as file:
            return file.read(1 << 16)
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=e.strerror or e), str(path))) from None


def _refuse_others(path: Path, head: bytes) -> None:
    """Say of a file that is no DXF what it is."""
    if not head:
        raise BadInput(Problem(tell("the file is empty"), str(path), hint=tell(AS_DXF)))
    if head.startswith(b"AC10"):
        raise BadInput(Problem(tell("this is a DWG file, only DXF can be read"), str(path), hint=tell(AS_DXF)))
    for mark, name in OTHERS.items():
        if head.startswith(mark):
            hints = [tell(AS_DXF), *([tell("photographs and scans are compared with --image")] if name in PICTURES else [])]
            raise BadInput(Problem(tell("this is a {kind} file, not DXF").format(kind=name), str(path), hint="; ".join(hints)))
    if b"SECTION" not in head:
        raise BadInput(Problem(tell("this is not a DXF file"), str(path), hint=tell(AS_DXF)))


@contextmanager
def _silent_library() -> Iterator[None]:
    """The library tells its log of every small repair; what matters is told in the notes."""
    log = logging.getLogger("ezdxf")
    before = log.level
    log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        log.setLevel(before)


def _completed(data: bytes) -> bytes | None:
    """A text file that was cut off, up to its last whole entity; None when it has its end."""
    if data.startswith(BINARY) or b"EOF" in data[-200:]:
        return None
    begins = [m.start() for m in re.finditer(rb"\n[ \t]*0[ \t]*\r?\n(?=[A-Z])", data)]
    return data[: begins[-1]] + b"\n  0\nENDSEC\n  0\nEOF\n" if begins else None


def words(text: str, encoding: str) -> str:
    """Text that was read with the wrong code page, as it was meant: UTF-8 or Russian Windows; of a code the letter it is for."""
    from ezdxf.lldxf.encoding import decode_dxf_unicode, has_dxf_unicode

    if has_dxf_unicode(text):  # of a letter that the code page lacks: then that is the right one
        text = decode_dxf_unicode(text)
    elif not text.isascii() and encoding.lower().replace("-", "") not in ("utf8", "cp1251"):
        with suppress(UnicodeError, LookupError):
            data = text.encode(encoding, "surrogateescape")
            with suppress(UnicodeDecodeError):
                return data.decode("utf-8")
            # The sign of a diameter is a letter to Unicode, and Ш in the Russian code page.
            letters = [c for c in text if (c.isalpha() and c not in "Øø") or "\udc80" <= c <= "\udcff"]
            if sum(c > "\x7f" for c in letters) > len(letters) / 2:
                return data.decode("cp1251", "replace")
    return text.encode("utf-8", "replace").decode("utf-8")


BYLAYER, BYBLOCK, DEFAULT = -1, -2, -3
"""Codes of line weights."""


class _EntityLook(NamedTuple):
    """Layer, name of the line type in lower case, line weight in hundredths of a millimetre or one of the negative codes."""

    layer: str
    linetype: str
    weight: int


class DxfReader:
    """Takes entities apart and counts those it cannot read."""

    def __init__(self, document: Document, file: Path) -> None:
        self.document = document
        self.file = file
        self.parts = self.points = 0
        self.patterns = {line.dxf.name.lower(): _pattern(line) for line in document.linetypes}
        scale = float(document.header.get("$LTSCALE", 1.0))
        self.dashes = {line.dxf.name.lower(): scale * max(_dashes(line), default=0.0) for line in document.linetypes}
        self.layers = {layer.dxf.name.lower(): _EntityLook(layer.dxf.name, layer.dxf.get("linetype", "Continuous").lower(),
                                                           int(layer.dxf.get("lineweight", DEFAULT))) for layer in document.layers}
        self.frozen = {layer.dxf.name.lower() for layer in document.layers if layer.is_frozen()}
        self.hidden = {"defpoints", *self.frozen, *(layer.dxf.name.lower() for layer in document.layers if layer.is_off())}
        self.unread: Counter[str] = Counter()
        self.nowhere = 0
        self.skipped = self.copied = 0
        self.raised = False
        self.stretched: dict[str, float] = {}

    def notes(self) -> list[str]:
        """What was left out."""
        unread = ", ".join(f"{n} {kind}" for kind, n in sorted(self.unread.items()))
        blocks = [f"{name} (1 : {told(f'{times:.3g}')})" for name, times in self.stretched.items()]
        more = ["…"] if len(blocks) > MOST_NAMED else []
        said = {
            tell("left out, not lines or text: {what}").format(what=unread): self.unread,
            tell("left out, with coordinates that are no numbers: {n} entities").format(n=self.nowhere): self.nowhere,
            tell("left out, in the place of {most} others: {n} lines").format(most=MOST_COPIES, n=self.copied): self.copied,
            tell("left out, on layers that are off or frozen: {n} entities").format(n=self.skipped): self.skipped,
            tell("some of the drawing has heights (z): it is seen from above"): self.raised,
            tell("blocks drawn out of proportion, width : height: {blocks}").format(
                blocks=", ".join([*blocks[:MOST_NAMED], *more])): self.stretched,
        }
        return [note for note, applies in said.items() if applies]

    def count(self, parts: int = 0, points: int = 0) -> None:
        """Take what was found into account: small files may come to more than the memory holds.

        Raises
        ------
        CannotBuild
            when there are more entities than a drawing of a student has.
        """
        self.parts += parts
        self.points += points
        if self.parts > MOST_PARTS or self.points > MOST_POINTS:
            said = (tell("{file}: with its blocks, arrays and curves taken apart it has more than {parts} entities")
                    if self.parts > MOST_PARTS else
                    tell("{file}: with its blocks, arrays and curves taken apart it has more than {points} points"))
            raise CannotBuild(said.format(file=self.file, parts=MOST_PARTS, points=MOST_POINTS), tell(SMALLER))

    def space(self, name: str, layout: Any) -> DrawingSpace:
        """Everything drawn in a layout.

        Raises
        ------
        CannotBuild
            when there are more entities than a drawing of a student has.
        """
        entities: list[Entity] = []
        found: list[DrawnStroke | Area | Writing] = []
        parts = list(self._parts(layout))
        fine = self._sagitta(e for _, e, _ in parts)
        attributes = {e.dxf.text for _, e, _ in parts if e.dxftype() == "ATTRIB"}
        for outer, e, look in parts:
            kind = e.dxftype()
            if look.layer.lower() in self.hidden or e.dxf.get("invisible", 0):
                # What programs without attributes are to show is there for the others as attribute.
                twice = e.dxf.get("invisible", 0) and kind == "TEXT" and e.dxf.text in attributes
                self.skipped += look.layer.lower() != "defpoints" and not twice
                continue
            entities.append(Entity(outer.dxftype(), words(look.layer, self.document.encoding),
                                   str(outer.dxf.get("handle", "") or "?"),
                                   self.patterns.get(look.linetype, "continuous"),
                                   look.weight / 100 if look.weight >= 0 else None, _breadth(e, kind),
                                   self.dashes.get(look.linetype, 0.0) * float(e.dxf.get("ltscale", 1.0))))
            try:
                found.extend(self._contents(e, kind, len(entities) - 1, fine))
            except (ValueError, TypeError, AttributeError, ZeroDivisionError, KeyError, IndexError, ArithmeticError):
                self.unread[kind] += 1  # a broken entity must not hide the others; what was read before an error stays
        return self._clean(name, entities, found, fine)

    def _clean(self, name: str, entities: list[Entity], found: Sequence[DrawnStroke | Area | Writing], fine: float) -> DrawingSpace:
        """A space without what has no size, whose coordinates are no numbers, or what lies in its own place again and again."""
        strokes = [s for s in found if isinstance(s, DrawnStroke)]
        self.nowhere += len({s.entity for s in strokes if not _are_finite(s.points)})
        strokes = [s for s in strokes if len(s.points) > 1 and _are_finite(s.points)]
        copies = Counter[bytes]()
        once = []
        for s in strokes:
            place = np.round(s.points / fine).tobytes()
            copies[place] += 1
            once += [s] if copies[place] <= MOST_COPIES else []
        self.copied += len(strokes) - len(once)
        areas = [a._replace(points=_open_ended(a.points)) for a in found if isinstance(a, Area) and _are_finite(a.points)]
        writings = (w for w in found if isinstance(w, Writing) and isfinite(w.height) and _are_finite(np.array([w.at]))
                    and w.text.strip())
        return DrawingSpace(name, tuple(once), tuple(a for a in areas if len(a.points) > 2), tuple(writings), tuple(entities))

    def _contents(self, e: Any, kind: str, n: int, fine: float) -> Iterator[DrawnStroke | Area | Writing]:
        """What one primitive, entity number ``n``, draws."""
        if kind in ("TEXT", "ATTRIB"):
            yield from _text(e, n, self.document.encoding)
        elif kind == "MTEXT":
            yield from _mtext(e, n, self.document.encoding)
        elif kind in ("SOLID", "TRACE"):
            yield Area(_xy(e.wcs_vertices()), n)
        elif kind in ("HATCH", "MPOLYGON"):
            lines, outlines = _hatch(e, fine)
            self.count(len(lines), sum(map(len, outlines)))
            yield from (Area(p, n, not lines) for p in outlines)
            yield from (DrawnStroke(p, n) for p in lines)
        else:
            for p in self._lines(e, kind, fine):
                self.count(points=len(p))
                yield DrawnStroke(p, n)
            yield from (Area(p, n) for p in _tapering_outlines(e, kind))

    def paper(self, layout: Any, model: DrawingSpace) -> DrawingSpace:
        """A sheet of paper space together with what its viewports show of the model."""
        name = tell('layout "{name}"').format(name=words(layout.name, self.document.encoding))
        space = replace(self.space(name, layout), paper=True)
        for port in layout.query("VIEWPORT"):
            if port.dxf.get("id", 1) == 1 or not port.dxf.get("status", 1) or port.dxf.layer.lower() in self.hidden:
                continue
            if port.get_scale() > 0 and model.strokes:
                zero, one = _xy(port.get_transformation_matrix().transform_vertices([(0, 0, 0), (1, 0, 0)]))
                low, high = _xy(port.clipping_rect())
                space = _with_viewport(space, model, Placing(complex(one - zero), complex(zero)), low, high)
        return space

    def _parts(self, layout: Any) -> Iterator[tuple[DXFEntity, DXFEntity, _EntityLook]]:
        """Entity of the layout, primitive it consists of, look of that primitive."""
        for e in layout:
            try:
                yield from ((e, part, look) for part, look in self._primitives(e, None))
            except (ValueError, TypeError, AttributeError, KeyError, ZeroDivisionError, RecursionError):
                self.unread[e.dxftype()] += 1

    def _primitives(self, e: Any, of: _EntityLook | None, within: tuple[str, ...] = ()) -> Iterator[tuple[DXFEntity, _EntityLook]]:
        """Primitives of an entity; ``of`` is the look of the block reference or dimension it is part of."""
        from ezdxf.protocols import SupportsVirtualEntities, virtual_entities

        self.count(parts=1)
        kind, look = e.dxftype(), self._look(e, of)
        if kind in PRIMITIVE or not (kind == "INSERT" or isinstance(e, SupportsVirtualEntities)):
            yield e, look
            return
        if kind == "INSERT" and look.layer.lower() in self.frozen:  # unlike one on a layer that is only off
            self.skipped += 1
            return
        name = str(e.dxf.get("name", "")).lower() if kind == "INSERT" else ""
        missing = kind == "INSERT" and e.block() is None
        if missing or (name and name in within) or len(within) > DEEPEST:  # blocks that hold one another
            self.unread[kind] += 1
            return
        if kind == "INSERT":
            across, up = abs(e.dxf.xscale), abs(e.dxf.yscale)
            if min(across, up) > 0 and abs(up / across - 1) > STRETCHED:
                self.stretched[e.dxf.name] = up / across
        if kind == "INSERT" and e.mcount > 1:
            inner = e.multi_insert()
        else:
            within = (*within, name) if name else within
            inner = chain(e.attribs if kind == "INSERT" else (), virtual_entities(e))
        for part in inner:
            yield from self._primitives(part, look, within)

    def _look(self, e: Any, of: _EntityLook | None) -> _EntityLook:
        """Layer, line type and weight of an entity, as its layer or what it is part of determines them."""
        layer = e.dxf.get("layer", "0")
        if layer == "0" and of is not None:
            layer = of.layer
        line, weight = e.dxf.get("linetype", "BYLAYER").lower(), int(e.dxf.get("lineweight", BYLAYER))
        of_layer = self.layers.get(layer.lower(), _EntityLook(layer, "continuous", DEFAULT))
        by_block = of if of is not None else _EntityLook(layer, "continuous", DEFAULT)
        line = of_layer.linetype if line == "bylayer" else by_block.linetype if line == "byblock" else line
        weight = of_layer.weight if weight == BYLAYER else by_block.weight if weight == BYBLOCK else weight
        return _EntityLook(layer, line, weight)

    def _sagitta(self, parts: Iterator[Any]) -> float:
        """Sagitta for flattening, from the approximate size of the drawing."""
        z = []
        keys = {"LINE": ("start", "end"), "CIRCLE": ("center",), "ARC": ("center",), "TEXT": ("insert",), "MTEXT": ("insert",)}
        for e in parts:
            at = [e.dxf.get(key) for key in keys.get(e.dxftype(), ())]
            z += [complex(p[0], p[1]) for p in (e[:2] if e.dxftype() == "LWPOLYLINE" else at) if p is not None]
        p = np.array([at for at in z if _are_finite(np.array([at]))])
        if len(p) < 2:
            return 0.005
        # A few strays far off must not count.
        low, high = (complex(np.quantile(p.real, q), np.quantile(p.imag, q)) for q in (0.02, 0.98))
        return max(abs(high - low) * FINE, 1e-9)

    def _lines(self, e: Any, kind: str, fine: float) -> Iterator[Points]:
        """Centre lines of a primitive, curves in chords."""
        if kind in SILENT:
            return
        # A surface of facets is no line.
        if kind in UNREAD or kind == "POLYFACE" or (kind == "POLYLINE" and not (e.is_2d_polyline or e.is_3d_polyline)):
            self.unread[kind] += 1
        elif kind == "LINE":
            yield self._projected([e.dxf.start, e.dxf.end])
        elif kind == "LWPOLYLINE" and e.dxf.get("extrusion", (0, 0, 1))[2] == 1 and not e.has_arc:
            points = np.array([complex(x, y) for x, y in e.get_points("xy")])
            yield np.append(points, points[:1]) if e.closed and len(points) else points
        elif kind in CURVES:
            yield self._projected(list(e.flattening(max(fine, COARSEST * _extent(e, kind)))))
        else:
            from ezdxf import path

            for part in path.make_path(e, segments=16).sub_paths():
                yield self._projected(list(part.flattening(fine, segments=4)))

    def _projected(self, vertices: list[Any]) -> Points:
        """The vertices from above; that some have a height is noted."""
        self.raised = self.raised or any(abs(v.z) > 1e-6 for v in vertices)
        return _xy(vertices)


def _extent(e: Any, kind: str) -> float:
    """Rough size of a curve."""
    if kind == "SPLINE":
        points = np.array([tuple(p) for p in (e.control_points if len(e.control_points) else e.fit_points)])
        return float(np.ptp(points, axis=0).max(initial=0.0)) if len(points) else 0.0
    return float(e.dxf.major_axis.magnitude if kind == "ELLIPSE" else abs(e.dxf.radius))


def _xy(vertices: Any) -> Points:
    return np.array([complex(v[0], v[1]) for v in vertices])


def _are_finite(z: Points) -> bool:
    """Whether these are places of a drawing: numbers, and none beyond all measure."""
    return bool((np.abs([z.real, z.imag]) <= FARTHEST).all())


def _open_ended(z: Points) -> Points:
    """An outline without repeated points, not closed."""
    return np.asarray(z[np.abs(z - np.roll(z, 1)) > 1e-9 * (1 + np.abs(z).max(initial=0.0))])


def _text(e: Any, n: int, encoding: str) -> Iterator[Writing]:
    align, p, q = e.get_placement()
    name = align.name
    text, height = words(e.plain_text(), encoding), float(e.dxf.height)
    angle = radians(e.dxf.get("rotation", 0.0))
    width = LETTER_WIDTH * height * len(text) * float(e.dxf.get("width", 1.0))
    p = e.ocs().to_wcs(p)
    at = complex(p.x, p.y)
    if q is not None and name in ("ALIGNED", "FIT"):
        q = e.ocs().to_wcs(q)
        along = complex(q.x, q.y) - at
        yield Writing(text, at + along / 2, height, abs(along), float(np.angle(along)), n)
        return
    x = 1.0 if name.endswith("RIGHT") else 0.5 if name.endswith("CENTER") or name == "MIDDLE" else 0.0
    y = 1.0 if name.startswith("TOP") else 0.5 if name.startswith("MIDDLE") else 0.0
    yield Writing(text, at + np.exp(1j * angle) * complex(width * (0.5 - x), height * (0.5 - y)), height, width, angle, n)


def _mtext(e: Any, n: int, encoding: str) -> Iterator[Writing]:
    lines = [words(line, encoding) for line in e.plain_text(split=True) if line.strip()]
    height = float(e.dxf.get("char_height", 2.5))
    begins = BEGINNING.match(e.text)
    for size, times in HEIGHT.findall(begins.group() if begins else ""):
        height = float(size) * (height if times else 1.0) or height
    angle = radians(e.get_rotation())
    u = complex(np.exp(1j * angle))
    at = complex(e.dxf.insert.x, e.dxf.insert.y)
    place = int(e.dxf.get("attachment_point", 1)) - 1
    x, y = (place % 3) / 2, 1 - (place // 3) / 2
    pitch = 5 / 3 * height * float(e.dxf.get("line_spacing_factor", 1.0))
    whole = height + pitch * (len(lines) - 1)
    for i, line in enumerate(lines):
        width = LETTER_WIDTH * height * len(line)
        yield Writing(line, at + u * complex(width * (0.5 - x), whole * (1 - y) - i * pitch - height / 2), height, width, angle, n)


def _hatch(e: Any, fine: float) -> tuple[list[Points], list[Points]]:
    """Pattern lines (none of a solid one) and outlines."""
    from ezdxf import path
    from ezdxf.render import hatching

    outlines = [_xy(p.flattening(fine, segments=4)) for p in path.from_hatch(e)]
    if e.has_solid_fill or e.has_gradient_data:
        return [], outlines
    lines: list[Points] = []
    with suppress(hatching.HatchingError):
        lines.extend(_xy(ends) for ends in islice(hatching.hatch_entity(e), MOST_HATCH))
    return lines, outlines


def _tapering_outlines(e: Any, kind: str) -> Iterator[Points]:
    """Outlines of tapering segments of a polyline, by which arrow heads are drawn."""
    if kind != "LWPOLYLINE":
        return
    for (x, y, start, end), (x1, y1, _, _) in pairwise(e.get_points("xyse")):
        a, b = complex(x, y), complex(x1, y1)
        if abs(start - end) > 1e-9 and a != b:
            n = 1j * (b - a) / abs(b - a) / 2
            yield np.array([a + start * n, a - start * n, b - end * n, b + end * n])


def _breadth(e: Any, kind: str) -> float:
    """Width of a polyline that is equally broad everywhere, drawing units, else 0."""
    if kind == "LWPOLYLINE":
        if e.dxf.hasattr("const_width") and e.dxf.const_width > 0:
            return float(e.dxf.const_width)
        rows = e.get_points("se")
        widths = {float(w) for row in (rows if e.closed else rows[:-1]) for w in row}
    elif kind == "POLYLINE":
        widths = {float(e.dxf.get("default_start_width", 0.0)), float(e.dxf.get("default_end_width", 0.0))}
    else:
        return 0.0
    return widths.pop() if len(widths) == 1 else 0.0


def _pattern(line: Any) -> Pattern:
    """Class of a line type."""
    return "other" if line.pattern_tags.is_complex_type() else of_dashes(_dashes(line))


def _dashes(line: Any) -> list[float]:
    """Strokes (positive) and gaps (negative) of a line type."""
    return [float(tag.value) for tag in line.pattern_tags.tags if tag.code == 49]


def _with_viewport(paper: DrawingSpace, model: DrawingSpace, placing: Placing, low: complex, high: complex) -> DrawingSpace:
    """Paper space with the contents of one viewport: the model where the viewport shows it, clipped at its edges."""
    first, seen = len(paper.entities), model.placed(placing)
    port = Box(low.real, low.imag, high.real, high.imag)
    strokes = (DrawnStroke(part, s.entity + first) for s in seen.strokes for part in polyline_inside(port, s.points))
    areas = [a._replace(entity=a.entity + first) for a in seen.areas if port.contains(complex(a.points.mean()))]
    writings = [w._replace(entity=w.entity + first) for w in seen.writings if port.contains(w.at)]
    return replace(paper, strokes=paper.strokes + tuple(s for s in strokes if len(s.points) > 1),
                   areas=paper.areas + tuple(areas), writings=paper.writings + tuple(writings),
                   entities=paper.entities + seen.entities)
