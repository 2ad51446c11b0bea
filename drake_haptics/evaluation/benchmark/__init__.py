"""Benchmarks of the contact query on the reader's own machine.

Other libraries are measured in the same run where they are installed
(`pip install drake_haptics[peers]`). `drake-haptics bench` is the command.
"""
