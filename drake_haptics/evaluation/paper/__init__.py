"""Repeats the evaluation of the paper on this machine.

Kim, Otaduy, Lin and Manocha 2003, section 6: Table 1, Figures 11 and 12, and the
analysis of section 6.3. `drake-haptics paper` is the command.
"""
