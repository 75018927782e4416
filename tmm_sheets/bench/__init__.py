"""Work-precision benchmarks: every method's error against a truth of 30 digits or more, and the time it takes.

``truth`` shares nothing with the methods: loops closed by trigonometry in 100 digits, derivatives by differences of them, reactions
from one linear system of all links. The other modules have the rows of one field each, ``run`` collects them.
"""
