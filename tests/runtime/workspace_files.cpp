// Workspace files: what was written is read, and no other bytes are.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>

#include "runtime/workspace/format.hpp"
#include "schema/fnv1a.hpp"
#include "tests/runtime/some_shapes.hpp"
#include "wale/simulated.hpp"
#include "wale/workspace.hpp"

namespace wale::workspace_test {
namespace {

using namespace workspace_format;

Workspace some_workspace() {
  using namespace shape_test;
  Places places(5);
  const std::vector<glm::vec2> corners = star(places, 12);
  const std::vector<std::uint8_t> bits = random_bits(places, 11 * 7, 2);
  const Program rough = corduroy(1), soft = feeling_edge(20);
  const PatchSize size{0.04f, 0.03f, 0.001f};
  Workspace workspace{"kitchen", "What lies on the table.", {}};
  workspace.patches = {
      {"board", "oak", rough, {.at = {-0.03f, 0.01f}, .size = size}, {}},
      {"cloth",
       "denim(roughness: 0.3)",
       soft,
       {.at = {0.03f, 0}, .size = size, .layer = 0, .shape = *Shape::ellipse(0.02f, 0.015f)},
       {{"roughness", true, 0.2f, 0.45f, "still denim"}, {"yarn", false, std::nullopt, 0.002f, ""}}},
      {"river", "oil", soft, {.size = size, .layer = 0, .shape = *Shape::polygon(corners)}, {}},
      {"key",
       "oak",
       rough,
       {.size = PatchSize{0.011f, 0.007f, 0}, .layer = 0, .shape = *Shape::mask(bits, 11, 7, 0.001f)},
       {}},
      {"other key",
       "oak",
       rough,
       {.at = {0, 0.02f}, .size = size, .layer = 0, .shape = *Shape::ellipse(0.02f, 0.015f)},
       {}},
  };
  return workspace;
}

/// The bytes with the hash that they should have.
std::vector<std::byte> signed_again(std::vector<std::byte> bytes) {
  const std::uint64_t hash = Fnv1a<std::uint64_t>().take_all(std::span(bytes).subspan(header_size)).hash();
  std::memcpy(&bytes[16], &hash, sizeof hash);
  return bytes;
}

TEST(WorkspaceFiles, HoldAllOfAWorkspace) {
  const Workspace written = some_workspace();
  const std::vector<std::byte> bytes = write_workspace(written);
  const auto read = Workspace::load(bytes);
  ASSERT_TRUE(read) << in_words(read.error());
  EXPECT_EQ(read->name, written.name);
  EXPECT_EQ(read->documentation, written.documentation);
  ASSERT_EQ(read->patches.size(), written.patches.size());
  shape_test::Places places(9);
  for (std::size_t i = 0; i < written.patches.size(); ++i) {
    const WorkspacePatch &a = written.patches[i], &b = read->patches[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.made_of, b.made_of);
    EXPECT_EQ(a.marks, b.marks);
    EXPECT_EQ(a.options.at, b.options.at);
    EXPECT_EQ(a.options.size, b.options.size);
    EXPECT_EQ(write_patch_program(a.program.description()), write_patch_program(b.program.description()));
    for (int k = 0; k < 300; ++k) {
      const glm::vec2 at = places.in({0.1f, 0.1f});
      EXPECT_EQ(std::bit_cast<std::uint32_t>(a.options.shape.edge(at).metres),
                std::bit_cast<std::uint32_t>(b.options.shape.edge(at).metres));
    }
  }
  EXPECT_EQ(write_workspace(*read), bytes) << "the same workspace gives the same bytes";
  Workspace none{"nothing", "", {}};
  const auto empty = Workspace::load(write_workspace(none));
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->patches.empty());
}

TEST(WorkspaceFiles, GoOntoAStageAllAtOnce) {
  const auto workspace = Workspace::load(write_workspace(some_workspace()));
  SimulatedJoystick device(sandpaper(), {}, Rest{});
  Stage stage(device);
  const auto patches = put_on(stage, *workspace);
  ASSERT_TRUE(patches) << in_words(patches.error());
  EXPECT_EQ(patches->size(), 5u);
  EXPECT_EQ(stage.size(), 5u);
  Workspace wrong = some_workspace();
  wrong.patches.back().options.size = PatchSize{-1, 1, 0};
  EXPECT_FALSE(put_on(stage, wrong));
  EXPECT_EQ(stage.size(), 5u) << "none of the others";
}

TEST(WorkspaceFiles, CutShortOrChangedAreRefused) {
  const std::vector<std::byte> bytes = write_workspace(some_workspace());
  std::mt19937 random(1995);
  for (std::size_t length = 0; length < bytes.size(); length += 1 + random() % 97) {
    const auto cut = Workspace::load(std::span(bytes).first(length));
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().code, Code::damaged_file);
  }
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> changed = bytes;
    changed[random() % bytes.size()] ^= std::byte(1u << random() % 8);
    EXPECT_FALSE(Workspace::load(changed));
  }
  std::vector<std::byte> newer = bytes;
  newer[8] = std::byte{2};
  EXPECT_EQ(Workspace::load(newer).error().code, Code::newer_file);
}

TEST(WorkspaceFiles, ThatMakeNoSenseAreRefusedAlsoIfTheirHashIsRight) {
  const std::vector<std::byte> bytes = write_workspace(some_workspace());
  std::mt19937 random(1995);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> changed = bytes;
    const std::size_t at = header_size + random() % (bytes.size() - header_size);
    if (random() % 2 == 0)
      changed[at] = std::byte(random());
    else
      changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(at));
    const auto read = Workspace::load(signed_again(changed));
    refused += !read;
    if (read) {
      EXPECT_EQ(write_workspace(*read).size(), changed.size()) << "nothing is passed over";
    }
  }
  EXPECT_GT(refused, 1000);
  Workspace twice = some_workspace();
  twice.patches[1].name = "board";
  const auto named_twice = Workspace::load(write_workspace(twice));
  ASSERT_FALSE(named_twice);
  EXPECT_NE(named_twice.error().sentence.find("two patches called `board`"), std::string::npos);
}

}  // namespace
}  // namespace wale::workspace_test
