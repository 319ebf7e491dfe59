"""`python -m mpsdem`: the command line."""

from mpsdem.cli import main

main()
