"""The graphical methods of the manuals, one file each; they record steps and never know of drawings."""
