"""What a structure's file is written with: kernels, records, rules and operations, invariants."""
