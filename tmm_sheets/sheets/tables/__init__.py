"""Tables for the room that a sheet has left."""
