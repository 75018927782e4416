"""Comparing hand drawings with the exact construction: measured lengths, photographs, CAD drawings."""
