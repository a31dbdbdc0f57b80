"""Build-time code: FMUs without Python, compiled from the same kernel (extra ``[native]``)."""
