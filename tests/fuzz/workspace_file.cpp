// A libFuzzer target for workspace files. Any bytes are refused with a reason, or make a workspace that is written as
// the same bytes and put on a stage, or refused by it. The hash is corrected first, so that the fuzzer reaches the
// later checks. The first input is a workspace with each kind of shape.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/workspace/format.hpp"
#include "schema/fnv1a.hpp"
#include "tests/runtime/some_shapes.hpp"
#include "wale/workspace.hpp"

namespace {

using namespace wale;
using namespace wale::workspace_format;

void demand(bool condition) {
  if (!condition) std::abort();
}

const std::vector<std::byte>& a_workspace() {
  static const std::vector<std::byte> bytes = [] {
    const std::vector<glm::vec2> corners = {{-0.01f, -0.01f}, {0.01f, -0.01f}, {0, 0.01f}};
    const std::vector<std::uint8_t> cells = {1, 0, 1, 1, 1, 0};
    const Program program = shape_test::feeling_edge(20);
    const PatchSize size{0.04f, 0.03f, 0.001f};
    Workspace workspace{"kitchen", "What lies there.", {}};
    for (const Shape& shape :
         {Shape(), *Shape::ellipse(0.02f, 0.01f), *Shape::polygon(corners), *Shape::mask(cells, 3, 2, 0.01f)})
      workspace.patches.push_back({std::to_string(workspace.patches.size()),
                                   "oak",
                                   program,
                                   {.size = size, .layer = 0, .shape = shape},
                                   {{"roughness", true, 0.2f, std::nullopt, "still oak"}}});
    return write_workspace(workspace);
  }();
  return bytes;
}

}  // namespace

/// The input is a list of changes to a workspace's bytes, four bytes each: where (24 bits), and what.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::vector<std::byte> bytes = a_workspace();
  for (; size >= 4; data += 4, size -= 4) {
    const std::size_t at = data[0] | static_cast<std::size_t>(data[1]) << 8 | static_cast<std::size_t>(data[2]) << 16;
    if (at < bytes.size())
      bytes[at] = static_cast<std::byte>(data[3]);
    else if (at < 2 * bytes.size())
      bytes.resize(at - bytes.size());
  }
  if (bytes.size() >= header_size) {
    const std::uint64_t hash = Fnv1a<std::uint64_t>().take_all(std::span(bytes).subspan(header_size)).hash();
    std::memcpy(&bytes[16], &hash, sizeof hash);
  }
  const auto read = Workspace::load(bytes);
  if (!read) {
    demand(!read.error().sentence.empty());
    return 0;
  }
  // Programs and shapes that no patch uses are left out when it is written again; what is used is as it was.
  const auto again = Workspace::load(write_workspace(*read));
  demand(again && again->patches.size() == read->patches.size());
  demand(write_workspace(*again) == write_workspace(*read));
  Stage stage(sandpaper());
  if (const auto patches = put_on(stage, *read)) demand(patches->size() == read->patches.size());
  for (const WorkspacePatch& patch : read->patches)
    for (const float x : {0.0f, 0.004f, -1e30f}) (void)patch.options.shape.edge({x, -x});
  return 0;
}
