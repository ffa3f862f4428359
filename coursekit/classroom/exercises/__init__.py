"""The public half of every exercise, one module for each notebook."""
