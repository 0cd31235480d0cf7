"""One page with the motion of an analysis in three dimensions, which a browser opens from its file."""
