"""Curves as a car drives them: what a map says of them, judged over a car's length."""
