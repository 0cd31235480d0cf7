"""Questions as commands: how large, how often in fifty years, which of many, which parameters."""
