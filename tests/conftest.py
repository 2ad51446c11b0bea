"""What holds for all tests."""

import os
import signal

# Matrices here are small, and several workers share the cores: threads of linear
# algebra would wait for one another, a hundred times longer than the work takes.
# Before anything imports NumPy; programs that tests start inherit it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A job in a shell's background is born deaf to Ctrl-C, one under nohup to the end of
# its terminal, and so would be the programs that tests start and end by these signals.
# What is caught here is not ignored there.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, lambda *_: None)
