"""Vehicle and driver models that close the loop around the driving function."""
