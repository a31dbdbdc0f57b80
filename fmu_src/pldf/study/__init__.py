"""Drives, recordings, figures and studies; never packed into an FMU."""
