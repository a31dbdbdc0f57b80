"""OpenDRIVE files: their roads, a way through them, and its knots."""
