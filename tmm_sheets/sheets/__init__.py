"""A1 sheets: layout, frame, title block and the views, the only place where steps become marks."""
