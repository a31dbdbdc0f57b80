"""Recordings of drives: columns, interventions, offline learning, exports."""
