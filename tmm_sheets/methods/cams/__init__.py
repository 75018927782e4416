"""Cams: laws of motion, the zone of permitted centres, the profile by inversion."""
