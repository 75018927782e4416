"""Work-precision benchmarks: the error of every method against a truth of 30 digits or more, and its time.

``truth`` shares nothing with the methods: it closes loops by trigonometry in 100 digits, differentiates by differences, and gets
reactions from one linear system of all links. The other modules measure one field each; ``run`` collects their rows.
"""
