"""Legal limits along a way: what is stated, what is carried on, and speed signs."""
