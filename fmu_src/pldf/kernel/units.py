"""Speeds as people read them: the two factors between m/s and km/h."""

from __future__ import annotations

KMH_PER_MPS = 3.6
MPS_PER_KMH = 1.0 / KMH_PER_MPS
