"""The record of a project: every number with the step it comes from, every mark with the step it shows; docs/record.md."""
