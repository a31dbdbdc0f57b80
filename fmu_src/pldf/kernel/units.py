"""Speeds as people read them: km/h, or miles per hour."""

from __future__ import annotations

KMH_PER_MPS = 3.6
MPS_PER_KMH = 1.0 / KMH_PER_MPS
MPH_PER_MPS = 3600.0 / 1609.344
