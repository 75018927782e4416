"""Lengths measured on a hand drawing, judged through the record of steps."""
