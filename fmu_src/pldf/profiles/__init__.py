"""Learned profiles: what is stored, its file, and the store on disk."""
