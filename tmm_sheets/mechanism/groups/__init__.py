"""Kinds of Assur groups: five of class II, order 2, and one of class III, order 3; a new kind is a module here and a line below."""

from tmm_sheets.mechanism.groups.triad import TRIAD
from tmm_sheets.mechanism.groups.two_links import PRP, RPP, RPR, RRP, RRR
from tmm_sheets.mechanism.model import GroupKind

KINDS: dict[int, GroupKind] = {kind.number: kind for kind in (RRR, RRP, RPR, PRP, RPP, TRIAD)}
"""Every kind by its number in the manuals; PPP and RPP with parallel guides are no mechanisms."""

__all__ = ["KINDS", "PRP", "RPP", "RPR", "RRP", "RRR", "TRIAD", "GroupKind"]
