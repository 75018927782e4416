"""What holds for all tests."""

import os

os.environ["LANGUAGE"] = "en"  # messages are compared in the language of the code, wherever the tests run
# Programs that tests start keep their byte code: the next one begins sooner.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
