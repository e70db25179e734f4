"""How far the judge and the gate can be trusted, and other libraries beside ours."""
