"""What measures the program rather than draws with it: the benchmarks and the stability of the plans."""
