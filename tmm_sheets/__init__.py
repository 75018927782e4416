"""Course-project sheets of the theory of mechanisms and machines, drawn by compass-and-ruler constructions."""

__version__ = "0.1.0"
