"""Asks for a roughness by name, puts it under the hand, and reads back what came out of the handle."""

import sys

import wale


def main(name: str = "coarse") -> None:
    library = wale.Library()
    surface = library.level("roughness", name)
    for warning in surface.warnings:
        print("warning:", warning, file=sys.stderr)

    with wale.Stage(library.open_device("simulated")) as stage:
        patch = stage.add(surface)
        run = stage.run(seconds=3, virtual_time=True)
        felt = run.measure(patch, settling=0.5)

    for level in felt.levels:
        if level.level is not None:
            print(f"{name} {level.name}: {felt.rubbing.p99:.3f} N at the handle, felt as level {level.level:.2f}")


try:
    main(*sys.argv[1:2])
except wale.Error as error:
    sys.exit(str(error))
