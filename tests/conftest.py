"""What holds for all tests."""

import signal

# A shell's background job is born deaf to Ctrl-C, and so would be the programs that
# tests start and end by it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
