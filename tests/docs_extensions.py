"""Makes the Sphinx extensions of docs/_ext importable for tests."""

import sys
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
sys.path.insert(0, str(DOCS / "_ext"))
