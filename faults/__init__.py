"""The fault campaign: what is promised, tried hard and counted (docs/reliability.md)."""
