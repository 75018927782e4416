"""The record of a project: every number with its step, every mark with the step it shows; docs/record.md."""
