"""Files on disk: written atomically, under a lock."""
