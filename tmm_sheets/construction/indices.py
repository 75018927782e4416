"""Numbers of links as indices of names; without numpy, as the reader of project files needs them."""

from __future__ import annotations


def pair_index(j: str, k: str) -> str:
    """Two links as the index of what acts between them: 54; with a comma from two signs on: 1,10 is not 11,0."""
    return f"{j}{k}" if len(j) == len(k) == 1 else f"{j},{k}"


def on_link(point: str, link: str) -> str:
    """The point of a link that coincides with ``point`` of another one: B3; B,10 where the link's name has two signs or more."""
    return f"{point}{link}" if len(link) == 1 else f"{point},{link}"
