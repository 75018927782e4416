"""The living sheet: one page in which the construction is drawn, dragged and asked; docs/page.md."""
