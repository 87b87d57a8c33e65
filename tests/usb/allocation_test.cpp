#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/usb/allocations.hpp"
#include "tests/usb/pid_bus.hpp"

namespace wale::test {
namespace {

TEST(UsbAllocation, ARunningSessionDoesNotAllocateUpToItsEnd) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  ASSERT_EQ(bus.session.state(), hid::PidSession::State::running);
  const auto report = from_hex("01 01 00 00 00 00 00 00 00 FE FF 10 27 00 00 00 00 00 00 00 00 00 00 00 00");
  const auto nonsense = from_hex("01 02");
  long taken = 0, steps = 0;
  const long before = allocations;
  for (std::int64_t now = bus.now; bus.session.state() != hid::PidSession::State::over; now += 1000, ++steps) {
    const double t = static_cast<double>(steps);
    bus.session.command({std::sin(t), std::cos(t)}, now);
    bus.session.receive(steps < 3000 ? report : nonsense, now);
    while (const auto transfer = bus.session.next(now)) {
      bus.session.finish(*transfer, hid::Outcome::done, {}, now);
      ++taken;
    }
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(taken, 3000);
  EXPECT_TRUE(bus.session.was_lost());
  { const std::vector<int> some(100); }
  EXPECT_EQ(allocations, before + 1) << "an allocation is noticed";
}

}  // namespace
}  // namespace wale::test
