"""Sheets as files: one project or many, what has not changed, and paper."""
