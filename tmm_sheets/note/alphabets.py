"""What the formulas of a note are written in: an alphabet for each way of writing their trees."""

from __future__ import annotations

from xml.sax.saxutils import escape

from tmm_sheets.construction.formula import (
    Alphabet,
    Barred,
    Fenced,
    Figures,
    FormulaRow,
    Fraction,
    Letters,
    Node,
    Root,
    Scripts,
    Sign,
    Underlined,
    Words,
    spelt,
)

# --- Typst's mathematics

_SIGNS = {
    "·": "dot.op", "∥": "parallel", "⟂": "perp", "|": "bar.v", "/": "slash", "(": "\\(", ")": "\\)", ",": '","', ";": '";"',
    "′": "prime", "″": "prime.double", ":": '":"', "°": '"°"', "–": '"–"', "%": '"%"', "*": '"*"', "…": "dots.h",
}  # fmt: skip
_GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta", "θ": "theta", "κ": "kappa",
    "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau", "φ": "phi", "χ": "chi",
    "ψ": "psi", "ω": "omega", "Δ": "upright(Delta)", "Σ": "upright(Sigma)", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega", "Θ": "Theta",
}  # fmt: skip


def string(text: str) -> str:
    """A string literal of Typst."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def _letter(text: str) -> str:
    return _GREEK.get(text) or (text if text.isascii() and text.isalpha() and len(text) == 1 else string(text))


def _sign(text: str) -> str:
    return _SIGNS.get(text, text)


TYPST: Alphabet[str] = {
    Letters: _letter,
    Figures: lambda text, source: string(text),
    Words: lambda text: " space " if text == " " else string(text),
    Sign: _sign,
    FormulaRow: lambda items: " ".join(items) or '""',
    Scripts: lambda base, below, above: f"attach({base}{f', t: {above}' if above else ''}{f', b: {below}' if below else ''})",
    Fraction: lambda over, under: f"frac({over}, {under})",
    Root: lambda of: f"sqrt({of})",
    Fenced: lambda left, of, right: f"lr({_sign(left)} {of} {_sign(right)})",
    Barred: lambda of: f"overline({of})",
    Underlined: lambda of, times: "underline(" * times + of + ")" * times,
}

# --- the equations of Word

_MATH = "http://schemas.openxmlformats.org/officeDocument/2006/math"
_WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_FONT = '<w:rPr><w:rFonts w:ascii="Cambria Math" w:hAnsi="Cambria Math" w:cs="Cambria Math"/></w:rPr>'


def equation(node: Node) -> str:
    """An equation in a line of text, as OMML."""
    return f'<m:oMath xmlns:m="{_MATH}" xmlns:w="{_WORD}">{spelt(node, OMML)}</m:oMath>'


def _run(text: str, upright: bool = True) -> str:
    look = "<m:rPr><m:nor/></m:rPr>" if upright else ""
    return f'<m:r>{look}{_FONT}<m:t xml:space="preserve">{escape(text)}</m:t></m:r>'


def _tag(name: str, *inside: str) -> str:
    return f"<m:{name}>{''.join(inside)}</m:{name}>"


def _value(name: str, value: str) -> str:
    return f'<m:{name} m:val="{escape(value)}"/>'


def _bar(place: str, of: str, times: int = 1) -> str:
    return f"<m:bar><m:barPr>{_value('pos', place)}</m:barPr><m:e>" * times + of + "</m:e></m:bar>" * times


def _attached(base: str, below: str | None, above: str | None) -> str:
    name = "sSubSup" if below and above else "sSub" if below else "sSup"
    parts = [_tag(k, v) for k, v in (("e", base), ("sub", below), ("sup", above)) if v]
    return _tag(name, *parts) if len(parts) > 1 else base


OMML: Alphabet[str] = {
    Letters: lambda text: _run(text, not text.isalpha()),
    Figures: lambda text, source: _run(text),
    Words: _run,
    Sign: _run,
    FormulaRow: "".join,
    Scripts: _attached,
    Fraction: lambda over, under: _tag("f", _tag("num", over), _tag("den", under)),
    Root: lambda of: _tag("rad", _tag("radPr", _value("degHide", "1")), "<m:deg/>", _tag("e", of)),
    Fenced: lambda left, of, right: _tag("d", _tag("dPr", _value("begChr", left), _value("endChr", right)), _tag("e", of)),
    Barred: lambda of: _bar("top", of),
    Underlined: lambda of, times: _bar("bot", of, times),
}

# --- how wide they are

WIDTH: Alphabet[int] = {
    Letters: lambda text: 1,
    Figures: lambda text, source: len(text),
    Words: len,
    Sign: lambda text: 2 if text in "=+−·" else 1,
    FormulaRow: sum,
    Scripts: lambda base, below, above: base + (7 * max(below or 0, above or 0) + 9) // 10,
    Fraction: lambda over, under: max(over, under) + 1,
    Root: lambda of: of + 1,
    Fenced: lambda left, of, right: of + 1,
    Barred: lambda of: of,
    Underlined: lambda of, times: of,
}


def characters(node: Node) -> int:
    """About how many characters wide a formula is."""
    return spelt(node, WIDTH)
