"""What each section of a note shows: fields, formulas, tables and figures for its phrase template."""
