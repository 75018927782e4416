"""Gear pairs, racks and planetary reducers."""
