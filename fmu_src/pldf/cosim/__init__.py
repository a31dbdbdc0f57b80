"""FMUs as an importer sees them, the master that couples the three, and which FMUs drive."""
