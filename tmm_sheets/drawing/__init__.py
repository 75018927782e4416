"""Display list in millimetres: marks, line types, lettering, symbols, labels."""
