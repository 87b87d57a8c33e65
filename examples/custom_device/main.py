"""A device that Wale has no driver for: its figures are declared in Wale, so that shipped materials are compiled for it by
their names, and the program reads its handle and pushes it at every tick. Here the handle is a mass on a spring that was
pulled aside.
"""

import sys

import wale

DECLARED = """wale 1

export device rail_stick {
  class     force_plane
  workspace disc(100 mm)
  position  8192 counts
  force     4 N, 1000 counts
  rate      1000 Hz
  speed     assumed 1 m/s
  slew      assumed 100 N/s
  velocity_filter 15, 1 counts
  patch     80 mm, 80 mm, 5 mm
  mass      assumed 0.1 kg
  damping   assumed 1 N s/m
  friction  assumed 0.05 N
  delay     assumed 1 ms
  sustained unknown
  active    assumed 1 W
  source    "the maker's data sheet"
}
"""

MASS, SPRING = 0.1, 40.0  # kg, N/m


def main() -> None:
    library = wale.Library(devices=DECLARED)
    honey = library.find("honey", device="rail_stick")
    stick = library.profile("rail_stick")
    place, velocity, swing = 0.03, 0.0, 0.0  # m, m/s, m in the last half second
    with wale.Stage(stick) as stage:
        stage.add(honey)
        with wale.Loop(stage) as loop:
            for tick in range(int(2 * stick.rate)):
                force, _unused = loop.step((round(place / stick.position_step), 0))  # all guards are in it
                velocity += (force - SPRING * place) / MASS / stick.rate
                place += velocity / stick.rate
                if tick > 1.5 * stick.rate:
                    swing = max(swing, abs(place))
    print(f"in honey the handle swings by {1000 * swing:.1f} mm after 2 s, and by 30 mm at first")


try:
    main()
except wale.Error as error:
    sys.exit(str(error))
