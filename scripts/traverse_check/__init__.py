"""The check of a railway bridge by EN 1991-2 and EN 1990, from a few words to verdicts and a report: traverse-check."""
