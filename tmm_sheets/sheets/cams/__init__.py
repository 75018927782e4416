"""Views of cams: law of motion, dimensions by the allowed zone, profile by inversion."""
