"""What is measured and drawn with glid_nb from a checkout; never installed."""
