// Recordings of shapes: replayed bit for bit, and refused where their bytes make no sense.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "runtime/record/event_stream.hpp"
#include "tests/runtime/recorded.hpp"
#include "tests/runtime/some_shapes.hpp"

namespace wale::shape_test {
namespace {

TEST(RecordedShapes, AreReplayedBitForBit) {
  const TemporaryFolder folder;
  Places places(3);
  const std::vector<glm::vec2> corners = star(places, 9);
  const std::vector<std::uint8_t> bits = random_bits(places, 7 * 5, 2);
  const Shape shapes[] = {*Shape::ellipse(0.03f, 0.02f), *Shape::polygon(corners), *Shape::mask(bits, 7, 5, 0.008f)};
  const std::string file = folder / "run.wrec";
  recorded::Puppet device(recorded::roaming);
  {
    Stage stage(device, {.record = RecordTo{.file = file, .hand = ""}});
    for (int i = 0; i < 12; ++i)
      ASSERT_TRUE(stage.add(feeling_edge(20 + 5 * static_cast<float>(i)),
                            {.at = places.in({0.15f, 0.08f}), .layer = static_cast<float>(i), .shape = shapes[i % 3]}));
    Patch stretched = *stage.add(feeling_edge(90), {.size = PatchSize{0.02f, 0.06f, 0.001f}, .shape = shapes[1]});
    bool done = false;
    const auto change = [&](const Now& now) {
      if (done || now.ticks_run < 900) return;
      done = true;
      ASSERT_TRUE(stretched.resize({0.05f, 0.04f, 0.001f}));
      ASSERT_TRUE(stretched.move({0.01f, 0}));
    };
    recorded::run(stage, {.seconds = 3, .virtual_time = true, .progress = change});
    ASSERT_TRUE(done);
  }
  const Recording recording = recorded::opened(file);
  recorded::expect_same(recording);
  std::set<const void*> kept;
  for (const RecordedEvent& event : recording.events())
    if (event.kind == RecordedEvent::Kind::put) kept.insert(event.shape.unstretched().identity());
  EXPECT_EQ(kept.size(), 3u) << "each shape is kept once";
  std::size_t crossed = 0;
  for (std::size_t i = 1; i < recording.ticks(); ++i) crossed += recording.tick(i).patch != recording.tick(i - 1).patch;
  EXPECT_GT(crossed, 20u) << "the hand goes over their edges";
}

/// What a recording with one shape says if the payload of its shape event is replaced.
std::string with_shape(const std::string& file, const ByteWriter& payload) {
  using namespace recording_format;
  std::vector<std::byte> bytes = recorded::bytes_of(file);
  for (std::size_t at = first_chunk; at + chunk_header_size < bytes.size(); at += chunk_size) {
    ChunkHeader chunk;
    std::memcpy(&chunk, &bytes[at], sizeof chunk);
    if (chunk.kind != ChunkKind::events) continue;
    for (std::size_t event = at + chunk_header_size;;) {
      EventHeader header;
      std::memcpy(&header, &bytes[event], sizeof header);
      if (header.size == 0) return "no shape";
      if (header.kind == static_cast<std::uint32_t>(EventCode::shape)) {
        EXPECT_EQ(header.size - 1, payload.result().size());
        std::ranges::copy(payload.result(), bytes.begin() + static_cast<std::ptrdiff_t>(event + sizeof header));
        header.check = check_of(header, payload.result());
        std::memcpy(&bytes[event], &header, sizeof header);
        return recorded::refused(Recording::read(bytes, "run.wrec"));
      }
      event += aligned(sizeof header + header.size - 1);
    }
  }
  return "no events";
}

TEST(RecordedShapes, AreRefusedWhereTheyMakeNoSense) {
  const TemporaryFolder folder;
  int number = 0;
  const auto record = [&](const Shape& shape) {
    const std::string file = folder / ("run" + std::to_string(number++) + ".wrec");
    Still device({0, 0});
    Stage stage(device, {.record = RecordTo{.file = file, .hand = ""}});
    EXPECT_TRUE(stage.add(feeling_edge(1), {.shape = shape}));
    recorded::run(stage, {.seconds = 0.1, .virtual_time = true});
    return file;
  };
  const auto expect_refused = [](const std::string& file, const ByteWriter& payload, const char* because) {
    const std::string said = with_shape(file, payload);
    EXPECT_NE(said.find(because), std::string::npos) << said;
  };
  const auto ellipse = [](std::uint32_t kind, float half_width) { return ByteWriter() << kind << half_width << 0.02f; };
  const std::string round = record(*Shape::ellipse(0.03f, 0.02f));
  expect_refused(round, ellipse(1, 0.01f), "not refused");
  expect_refused(round, ellipse(4, 0.01f), "the kind 4 of a shape is unknown");
  expect_refused(round, ellipse(1, std::nanf("")), "half axes");

  const auto polygon = [](std::uint32_t count, float y) {
    return ByteWriter() << std::uint32_t{2} << count << -0.01f << 0.0f << 0.01f << 0.0f << 0.0f << y;
  };
  const std::vector<glm::vec2> corners = {{-0.01f, 0}, {0.01f, 0}, {0, 0.02f}};
  const std::string triangle = record(*Shape::polygon(corners));
  expect_refused(triangle, polygon(3, 0.01f), "not refused");
  expect_refused(triangle, polygon(3, 0), "edge turns back");
  expect_refused(triangle, polygon(0xffffffffu, 0.01f), "corners");

  const auto mask = [](std::uint32_t columns, std::uint32_t rows, int cells) {
    return ByteWriter() << std::uint32_t{3} << columns << rows << 0.01f << static_cast<std::uint8_t>(cells);
  };
  const std::vector<std::uint8_t> bits = {1, 0, 1, 1};
  const std::string holed = record(*Shape::mask(bits, 2, 2, 0.01f));
  expect_refused(holed, mask(2, 2, 13), "not refused");
  expect_refused(holed, mask(2, 2, 0), "a bit that is set");
  expect_refused(holed, mask(2, 7, 13), "expected 2");
  expect_refused(holed, mask(0x10000u, 0x10000u, 13), "too many");
  expect_refused(holed, mask(0, 0, 13), "expected 0");
}

}  // namespace
}  // namespace wale::shape_test
