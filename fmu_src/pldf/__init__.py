"""Adaptive predictive longitudinal driving function (PLDF) that learns from its driver."""

__version__ = "0.1.0"
