"""Triangle meshes: reading, checks, repair, measures. No module here needs Drake."""
