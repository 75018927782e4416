"""The numbers of a project file that make a result least: wishes, the search, what came of it and its picture."""
