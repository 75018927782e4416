"""Formulas as OMML, the equations of Word: a function for each kind of node."""

from __future__ import annotations

from xml.sax.saxutils import escape

from tmm_sheets.note.formula import (
    Barred,
    Fenced,
    Figures,
    Fraction,
    Letters,
    Node,
    Root,
    Row,
    Scripts,
    Sign,
    Underlined,
    Words,
)

NAMESPACE = "http://schemas.openxmlformats.org/officeDocument/2006/math"
_WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_FONT = '<w:rPr><w:rFonts w:ascii="Cambria Math" w:hAnsi="Cambria Math" w:cs="Cambria Math"/></w:rPr>'


def equation(node: Node) -> str:
    """An equation in a line of text."""
    return f'<m:oMath xmlns:m="{NAMESPACE}" xmlns:w="{_WORD}">{written(node)}</m:oMath>'


def written(node: Node) -> str:
    """OMML of a node."""
    if isinstance(node, Letters):
        return _run(node.text, upright=not node.text.isalpha())
    if isinstance(node, Figures):
        return _run(node.text, upright=True)
    if isinstance(node, Words):
        return _run(node.text, upright=True)
    if isinstance(node, Sign):
        return _run(node.text, upright=True)
    if isinstance(node, Row):
        return "".join(map(written, node.items))
    if isinstance(node, Scripts):
        return _scripts(node)
    if isinstance(node, Fraction):
        return f"<m:f>{_part('num', node.over)}{_part('den', node.under)}</m:f>"
    if isinstance(node, Root):
        return f'<m:rad><m:radPr><m:degHide m:val="1"/></m:radPr><m:deg/>{_part("e", node.of)}</m:rad>'
    if isinstance(node, Fenced):
        left, right = escape(node.left), escape(node.right)
        return f'<m:d><m:dPr><m:begChr m:val="{left}"/><m:endChr m:val="{right}"/></m:dPr>{_part("e", node.of)}</m:d>'
    if isinstance(node, Barred):
        return _bar("top", written(node.of))
    assert isinstance(node, Underlined)
    made = written(node.of)
    for _ in range(node.times):
        made = _bar("bot", made)
    return made


def _run(text: str, upright: bool) -> str:
    look = "<m:rPr><m:nor/></m:rPr>" if upright else ""
    return f'<m:r>{look}{_FONT}<m:t xml:space="preserve">{escape(text)}</m:t></m:r>'


def _part(name: str, node: Node) -> str:
    return f"<m:{name}>{written(node)}</m:{name}>"


def _bar(place: str, inside: str) -> str:
    return f'<m:bar><m:barPr><m:pos m:val="{place}"/></m:barPr><m:e>{inside}</m:e></m:bar>'


def _scripts(node: Scripts) -> str:
    if node.below is not None and node.above is not None:
        return f"<m:sSubSup>{_part('e', node.base)}{_part('sub', node.below)}{_part('sup', node.above)}</m:sSubSup>"
    if node.below is not None:
        return f"<m:sSub>{_part('e', node.base)}{_part('sub', node.below)}</m:sSub>"
    if node.above is not None:
        return f"<m:sSup>{_part('e', node.base)}{_part('sup', node.above)}</m:sSup>"
    return written(node.base)
