"""What accuracy costs in time, measured on the reader's own machine.

`drake-haptics accuracy` is the command.
"""
