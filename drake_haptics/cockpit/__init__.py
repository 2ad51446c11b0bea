"""The cockpit: the page on which a run is seen, felt and changed.

The page is served by a process of its own, `drake_haptics.web.process`, so that drawing
and talking delay no tick. The loop's end of the way to it is a `PageLink`.
"""
