"""Measures how much time accuracy takes on this machine.

`drake-haptics accuracy` is the command.
"""
