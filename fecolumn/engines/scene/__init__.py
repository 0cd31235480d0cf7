"""What is drawn of an analysis: pieces, and fields on them."""
