"""Stability of the linkage plans on hard random mechanisms: what must hold whatever the numbers (``tmm-sheets stress``)."""
