"""The FMI 2.0 binding, written once for every model: it knows FMI and nothing about driving."""
