"""Measures what accuracy costs in time on this machine.

`drake-haptics accuracy` is the command.
"""
