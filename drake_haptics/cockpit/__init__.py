"""The cockpit: the page that shows a run and changes it.

A separate process, `drake_haptics.web.process`, serves the page, so that drawing and
communication delay no tick. The loop reaches it by a `PageLink`.
"""
