"""What views of several kinds share: graphs over an axis, titles, dimensions, crossings too flat to be drawn."""
