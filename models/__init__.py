"""The devices, meshes and scenes that the package ships."""

from pathlib import Path

# Beside this file wherever the package is: the link in `drake_haptics` of a clone may
# have been unpacked as a file of text.
FOLDER = Path(__file__).parent
