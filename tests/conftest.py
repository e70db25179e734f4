"""What all tests share."""

import signal

# In the background of a shell Ctrl-C is ignored, and would be by all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
