"""A lampshade of fifteen modules (Yang et al., SimuLearn, UIST 2020, Figure 16).

The shade is a surface of revolution, wider below (surfaces/lampshade.json). Five columns go around
it, three modules to a column. Modules that are alike are designed once: three. By one command:

    simulearn tile examples/surfaces/lampshade.json --modules 5x3 -o out/lampshade

    python examples/lampshade.py [-o out/lampshade] [--engine learned]
"""

import argparse
from pathlib import Path

from simulearn.grid import write_grid
from simulearn.show.tiling import deviation_map
from simulearn.tile import Settings, Tiled, read_tiling, tile
from simulearn.tile.pieces import pieces

SURFACE = Path(__file__).parent / "surfaces" / "lampshade.json"


def main(words: list[str] | None = None) -> Tiled:
    """Tile the shade, and write what is printed of it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/lampshade"))
    parser.add_argument("--engine", default="learned")
    parser.add_argument("--modules", type=int, nargs=2, default=(5, 3))
    parser.add_argument("--cells", type=int, nargs=2, default=(2, 2))
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    shade = read_tiling(SURFACE, tuple(options.modules), cells=tuple(options.cells))
    tiled = tile(shade, Settings(engine=options.engine), options.output)
    for piece in pieces(tiled):
        write_grid(piece.grid, options.output / f"{piece.name}.json")
        answer = tiled.answers[piece.kind]
        print(
            f"{piece.name}, {len(piece.modules)} copies: {answer.engine_mm:.2f} mm by the engine, "
            f"{answer.error_mm:.2f} mm by finite elements, {answer.designs} designs, "
            f"{answer.seconds:.0f} s"
        )
    print(
        f"mean fitting error {tiled.fit.error_mm:.2f} mm, largest gap {tiled.fit.gap_mm:.2f} mm, "
        f"in {tiled.seconds:.0f} s (paper: 4.44 mm in 12 min)"
    )
    deviation_map(tiled).savefig(options.output / "deviation.png")
    return tiled


if __name__ == "__main__":
    main()
