"""What the package ships: devices, tools and scenes."""
