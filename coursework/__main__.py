"""Entry point of ``python -m coursework``."""

from coursework.cli import main

main()
