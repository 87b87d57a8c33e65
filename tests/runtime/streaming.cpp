// Many patches that come and go during a run: nothing grows.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <thread>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/loop.hpp"
#include "wale/stage.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WALE_SANITIZED_HEAP 1  // a sanitizer's heap keeps what was freed, and mallinfo2 does not tell
#else
#define WALE_SANITIZED_HEAP 0
#endif

namespace wale::streaming_test {
namespace {

constexpr std::size_t there_at_once = 2000, at_a_time = 100;

/// A stage whose oldest patches leave and whose new ones come, in edits of 100, while a loop ticks.
class Stream {
 public:
  Stream() : stage_(sandpaper()), loop_(*Loop::begin(stage_)) {}

  /// So many edits, and waits until the loop has the last.
  void flow(int edits) {
    for (int i = 0; i < edits; ++i) {
      StageEdit edit = stage_.edit();
      for (std::size_t n = 0; n < at_a_time; ++n) patches_.push_back(*edit.add(programs_[come_++ % 2], place()));
      for (; patches_.size() > there_at_once; patches_.pop_front()) edit.remove(patches_.front());
      EXPECT_TRUE(edit.commit());
      const long before = stage_.now().revision;
      for (int steps = 0; steps < 20000 && stage_.now().revision == before; ++steps) {
        (void)loop_.step({});
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
      for (const Patch& each : patches_) greatest_ = std::max(greatest_, each.number());
    }
  }

  const Stage& stage() const { return stage_; }
  std::uint32_t greatest_number() const { return greatest_; }

 private:
  PatchOptions place() const {
    const auto n = static_cast<float>(come_ % 1000);
    return {.at = {0.0002f * n - 0.1f, 0.00001f * n}, .size = PatchSize{.width = 0.004f, .height = 0.004f}};
  }

  Stage stage_;
  Loop loop_;
  std::array<Program, 2> programs_{spring(40), bead(200)};
  std::deque<Patch> patches_;
  std::size_t come_ = 0;
  std::uint32_t greatest_ = 0;
};

TEST(Streaming, NeitherNumbersNorMemoryGrow) {
  Stream stream;
  stream.flow(60);  // three times as many patches as are there at once
  const std::uint32_t numbers = stream.greatest_number();
  const std::size_t memory = mallinfo2().uordblks;
  stream.flow(100);  // 10 000 more
  EXPECT_EQ(stream.stage().size(), there_at_once);
  EXPECT_LT(stream.greatest_number(), there_at_once + 4 * at_a_time) << "numbers of removed patches are used again";
  EXPECT_LE(stream.greatest_number(), numbers + at_a_time);
  // One patch takes more than 500 bytes; 10 000 that stay would take more than 5 MB.
  if (!WALE_SANITIZED_HEAP) {
    EXPECT_LT(mallinfo2().uordblks, memory + 500000);
  }
}

}  // namespace
}  // namespace wale::streaming_test
