#pragma once

#include <atomic>
#include <mutex>
#include <vector>

#include "runtime/device/driver.hpp"

namespace wale::made_up {

/// The hardware: a handle on rails, which tests plug in and move. Members that two threads use are atomic or guarded by
/// `mutex`.
struct Rails {
  std::atomic<bool> is_plugged_in{false};
  std::atomic<int> x{0}, y{0};  ///< counts
  std::atomic<int> open{0};     ///< the number of open devices
  std::atomic<long> looks{0};   ///< how often the driver was asked for its devices
  std::mutex mutex;
  std::vector<Force> forces;     ///< all commands, in order
  std::vector<int> descriptors;  ///< the descriptor of each opening
};
Rails& rails();

}  // namespace wale::made_up

namespace wale {

extern const Driver made_up_driver;

}  // namespace wale
