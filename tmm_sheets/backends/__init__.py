"""Output formats: one function each, imported only when asked for."""
