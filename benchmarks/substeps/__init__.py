"""What a coarse step changes, and what following it in parts removes."""
