"""Structure of a mechanism: links, kinematic pairs, Assur groups, mobility."""
