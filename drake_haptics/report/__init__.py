"""Writes tables, pages, plot labels and plain data of reports."""
