"""One page with the motion of an analysis in three dimensions, for any browser."""
