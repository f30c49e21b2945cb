"""What every package stands on: errors, arguments, results, progress, files; nothing of rotors."""
