// A window over a running material, 60 times a second: the hand as a cursor, and the marks that the material shows for
// it. The window is the terminal; with `--last` only the last frame is printed.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <thread>
#include <wale/wale.hpp>

namespace {

constexpr int columns = 64, rows = 32;

struct Window {
  std::array<std::string, rows> lines;
  float side;  // m

  explicit Window(float side) : side(side) { lines.fill(std::string(columns, ' ')); }
  void plot(glm::vec2 place, char mark) {
    const int column = static_cast<int>(std::floor((place.x / side + 0.5f) * columns));
    const int row = static_cast<int>(std::floor((0.5f - place.y / side) * rows));
    if (column >= 0 && column < columns && row >= 0 && row < rows) lines[row][column] = mark;
  }
};

void draw(Window& window, const wale::ShownMark& mark) {
  const auto& v = mark.values;
  if (mark.kind == wale::MarkKind::circle)
    for (int i = 0; i < 200; ++i)
      window.plot({v[0] + v[2] * std::cos(i * 0.0314f), v[1] + v[2] * std::sin(i * 0.0314f)}, '.');
  else if (mark.kind == wale::MarkKind::line)
    for (int i = 0; i <= 50; ++i) window.plot({v[0] + (v[2] - v[0]) * i / 50, v[1] + (v[3] - v[1]) * i / 50}, '#');
  else
    window.plot({v[0], v[1]}, 'o');
}

}  // namespace

int main(int argc, char** argv) {
  const bool last_only = argc > 1 && std::string_view(argv[1]) == "--last";
  const wale::Library library;
  wale::OpenOptions hand;
  hand.hand = {.mass = 0.2, .damping = 4, .stiffness = 400};
  hand.motion = wale::Circular{.radius = 0.04, .frequency = 0.5};
  auto device = library.open_device("simulated", hand);
  const auto dial = library.find("detent_dial");
  if (!device || !dial) return 1;
  wale::Stage stage(*std::move(device));
  auto patch = stage.add(dial->program, {.at = {0.005f, 0}});
  if (!patch || !stage.start()) return 1;

  std::size_t shown = 0;
  for (int frame = 0; frame < 60; ++frame) {
    std::this_thread::sleep_for(std::chrono::microseconds(16667));
    const wale::Now now = stage.now();       // never waits
    const auto picture = patch->snapshot();  // states and grids at one tick
    if (!picture) continue;
    // Marks count from the patch's centre, as the hand that they are asked for; the window does so too.
    const wale::Hand hand_there = wale::hand_on(now, picture->placement);
    Window window(0.16f);
    const auto marks = wale::show(picture->bank, picture->memory, hand_there);
    for (const wale::ShownMark& mark : marks) draw(window, mark);
    window.plot(hand_there.position, '+');
    shown += marks.size();
    if (last_only && frame < 59) continue;
    if (!last_only) std::printf("\033[H");
    for (const std::string& line : window.lines) std::printf("%s\n", line.c_str());
    std::printf("hand %5.1f, %5.1f mm   force %5.2f, %5.2f N\n", 1000 * now.position.x, 1000 * now.position.y,
                now.force.x, now.force.y);
  }
  return stage.stop() && shown > 0 ? 0 : 1;
}
