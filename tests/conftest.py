"""What holds for all tests."""

import os

os.environ["LANGUAGE"] = "en"  # messages are compared in the language of the code, wherever the tests run
