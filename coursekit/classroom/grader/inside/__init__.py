"""What is copied into the box: the runner, and stand-ins for what is absent there of the library."""
