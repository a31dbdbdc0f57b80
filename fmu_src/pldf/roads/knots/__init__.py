"""The roads of a way, sampled to the knots of a route and put behind each other."""
