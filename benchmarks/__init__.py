"""Error and run time of pendax beside its peers: `python -m benchmarks accuracy|special`."""
