"""A foreign trial of `compare` for photographs: a simulator that shares nothing with the program's own,
and a judge who knows the truth."""
