"""The code that drew the bundled samples."""
