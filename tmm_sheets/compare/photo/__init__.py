"""Comparing a photograph or scan of a hand drawing with the exact sheet."""
