"""Contact of bodies: compiled laws of gap, friction, impact and rolling."""
