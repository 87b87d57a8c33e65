// Draws the sampled maps of the benchmarks' materials: smooth hills of several sizes, as a 16-bit PGM of SIDE x SIDE
// pixels on the standard output.

#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 0;
  if (side < 2) {
    std::fputs("usage: draw_map SIDE\n", stderr);
    return 2;
  }
  std::printf("P5\n%d %d\n65535\n", side, side);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const double height = 0.5 + 0.2 * std::sin(0.11 * i) * std::cos(0.13 * j) +
                            0.15 * std::sin(0.037 * i + 0.029 * j) + 0.1 * std::cos(0.41 * j - 0.23 * i);
      const auto code = static_cast<unsigned>(height * 65535 + 0.5);
      std::putchar(static_cast<int>(code >> 8));
      std::putchar(static_cast<int>(code & 0xff));
    }
  }
}
