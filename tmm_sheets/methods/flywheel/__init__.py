"""The flywheel: reduced moments, works, the energy-mass curve and Mertsalov's method."""
