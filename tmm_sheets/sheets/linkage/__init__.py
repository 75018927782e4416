"""Views of a linkage: position plans, plans of velocities, accelerations and forces, levers, details, diagrams of its motion."""
