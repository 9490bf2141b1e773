"""Plots of a solve and the overview figure of a result."""
