"""Pictures and movies of one analysis, and its view in ParaView."""
