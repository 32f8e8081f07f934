"""The page on this machine, traverse serve."""
