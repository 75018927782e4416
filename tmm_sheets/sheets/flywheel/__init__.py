"""Views of the flywheel: graphs over the crank angle, energy-mass diagram, the wheel."""
