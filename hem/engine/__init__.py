"""How kernels are run: single, batched, timed, counted, interpreted."""
