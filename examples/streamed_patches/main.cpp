// A world larger than the workspace: ten thousand tiles are on the stage, and with each frame a column of a hundred
// leaves and another one comes, in one edit. The hand feels the tiles all the while.
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>
#include <wale/wale.hpp>

namespace {

constexpr int side = 100;            // tiles in a row and in a column
constexpr float tile = 0.1f / side;  // m
using Column = std::vector<wale::Patch>;

/// Adds one column of the world, of tiles of two materials, where the ring of columns has its place.
bool add_column(wale::StageEdit& edit, int column, const wale::Program& rough, const wale::Program& smooth,
                Column& to) {
  for (int row = 0; row < side; ++row) {
    const glm::vec2 at{((column % side) - side / 2 + 0.5f) * tile, (row - side / 2 + 0.5f) * tile};
    auto patch =
        edit.add((column / 5 + row / 5) % 2 ? rough : smooth, {.at = at, .size = wale::PatchSize{tile, tile, 0}});
    if (!patch) return false;
    to.push_back(*patch);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 60;
  const wale::Library library;
  const auto rough = library.level("roughness", "0.8");
  const auto smooth = library.level("roughness", "0.2");
  auto device = library.open_device("simulated");
  if (!rough || !smooth || !device) return 1;
  wale::Stage stage(*std::move(device));

  std::vector<Column> columns(side);
  wale::StageEdit edit = stage.edit();
  for (int column = 0; column < side; ++column)
    if (!add_column(edit, column, rough->program, smooth->program, columns[column])) return 1;
  if (!edit.commit() || !stage.start()) return 1;

  long ticks_on_a_tile = 0;
  for (int frame = 0; frame < frames; ++frame) {
    Column& oldest = columns[frame % side];
    for (const wale::Patch& each : oldest) edit.remove(each);
    oldest.clear();
    if (!add_column(edit, side + frame, rough->program, smooth->program, oldest) || !edit.commit()) return 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
    ticks_on_a_tile += stage.now().inside;
  }
  const auto run = stage.stop();
  if (!run) return 1;
  std::printf("%zu patches, %d streamed; %ld ticks, %ld missed, on a tile in %ld of %d frames\n", stage.size(),
              frames * side, run->ticks_run, run->ticks_missed, ticks_on_a_tile, frames);
  return stage.size() == side * side && ticks_on_a_tile > 0 ? 0 : 1;
}
