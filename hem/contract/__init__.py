"""What every structure offers: elements, queries, operations and memory, for whoever uses one."""
