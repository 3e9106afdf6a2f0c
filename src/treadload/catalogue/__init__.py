"""Named things from data files: one reader, and the data that come with the package."""
