"""What was done wrong: discrete hypotheses, each replayed through the record and held against what was measured."""
