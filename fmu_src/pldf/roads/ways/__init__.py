"""A way through a network of roads: which are driven, in which order and direction."""
