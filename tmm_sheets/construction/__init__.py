"""Compass and ruler: steps, rules, arithmetic, plans, scales, protocol."""
