"""Run the command line as `python -m simulearn.cli`."""

from simulearn.cli import main

if __name__ == "__main__":
    main()
