"""What several commands share: arguments, progress, messages. No command of its own."""
