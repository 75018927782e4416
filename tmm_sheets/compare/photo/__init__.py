"""A photograph or scan of a drawing against a sheet."""
