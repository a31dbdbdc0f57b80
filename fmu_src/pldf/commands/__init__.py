"""One module per command of ``pldf``: ``SUMMARY``, ``EXAMPLE``, ``configure`` and ``run``."""
