"""Positions, velocities, accelerations and forces of a linkage, its cycle and its loads."""
