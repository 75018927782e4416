"""One task: the project file's tables, units, names, messages, references to a synthesis, and the mechanism they assemble to."""
