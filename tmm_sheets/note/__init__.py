"""The explanatory note (расчётно-пояснительная записка): one document tree from the record and phrase templates, two writers."""
