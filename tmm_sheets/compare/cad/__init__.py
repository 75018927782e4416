"""A student's CAD drawing against a sheet."""
