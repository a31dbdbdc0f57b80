"""Pure numeric core: values in, values out.

Nothing below this package imports FMI, touches files, reads a clock, logs or draws hidden random
numbers (a test enforces it). Every function that runs per step, plans or learns stays inside the
subset that numba compiles without its runtime: attributes of record-like states, float64 arrays,
``+ - * /``, ``sqrt``, ``floor``, ``abs`` and comparisons; ``x * x`` instead of ``x**2``.
"""
