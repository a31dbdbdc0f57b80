"""A small model with every kind of variable, to test the FMI binding without any driving."""
