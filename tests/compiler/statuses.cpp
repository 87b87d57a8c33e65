// How a command ends that throws: never uncaught.

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

#include "compiler/command/print.hpp"

namespace wale::command {
namespace {

std::string said_by(const std::function<int()>& command, int expected) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(status_of(command), expected);
  return testing::internal::GetCapturedStderr();
}

TEST(Statuses, AreThoseThatCommandsReturn) {
  for (const int status : {0, 1, 2}) EXPECT_EQ(said_by([&] { return status; }, status), "");
}

TEST(Statuses, OfAnErrorInWaleIs3AndAsksForAReport) {
  const std::string said = said_by([]() -> int { throw std::out_of_range("map::at\x1b[2J\n"); }, 3);
  EXPECT_TRUE(said.starts_with("wale: an error in Wale itself: map::at\\u001b[2J\\u000a\n")) << said;
  EXPECT_NE(said.find("please report it"), std::string::npos) << said;
  EXPECT_NE(said_by([]() -> int { throw 1; }, 3).find("please report it"), std::string::npos);
}

TEST(Statuses, OfMissingMemoryIs1) {
  EXPECT_EQ(said_by([]() -> int { throw std::bad_alloc(); }, 1), "wale: there is not enough memory for it\n");
}

TEST(Statuses, OfAThreadThatTheSystemDoesNotGiveIs1) {
  const std::string said = said_by([]() -> int { throw std::system_error(EAGAIN, std::generic_category()); }, 1);
  EXPECT_EQ(said, "wale: the system gives no more memory or threads for it\n");
  EXPECT_NE(said_by([]() -> int { throw std::system_error(EIO, std::generic_category()); }, 3).find("report"),
            std::string::npos);
}

}  // namespace
}  // namespace wale::command
