"""Measures the speed of queries and loops on this machine.

Other libraries are measured in the same run if they are installed (`pip install
drake_haptics[peers]`). `drake-haptics bench` is the command.
"""
