"""The ten cases, one per file; each has `build(rng)`."""
