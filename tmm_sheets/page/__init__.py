"""The page in the browser: a local server, and behind it the commands; docs/serve.md."""
