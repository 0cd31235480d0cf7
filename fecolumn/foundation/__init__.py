"""What everything stands on: files, locks, compiled code, messages, checked keys."""
