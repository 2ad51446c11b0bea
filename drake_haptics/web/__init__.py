"""The page of a loop in the browser: its server, process, link and messages."""
