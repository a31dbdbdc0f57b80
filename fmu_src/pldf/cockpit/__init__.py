"""The cockpit: a page in which a person drives a study on the FMUs, and what serves it."""
