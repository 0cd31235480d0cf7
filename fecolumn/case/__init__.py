"""The case: what a user states, in its short and its full form."""
