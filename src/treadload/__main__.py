"""`python -m treadload` is the command line."""

from treadload.cli import main

main()
