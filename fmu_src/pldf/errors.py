"""The one error that a person is to read; apart from all else, so that it can always be raised."""


class ModelError(ValueError):
    """A parameter or a file cannot be used; the text says which, why and the way out."""
