#pragma once

#include <atomic>
#include <mutex>
#include <vector>

#include "runtime/device/driver.hpp"

namespace wale::made_up {

/// The hardware: a handle on rails, which tests plug in and push. What both sides use is guarded.
struct Rails {
  std::atomic<bool> is_plugged_in{false};
  std::atomic<int> x{0}, y{0};  ///< counts
  std::atomic<int> open{0};     ///< devices that are open on it
  std::atomic<long> looks{0};   ///< how often its driver was asked what is plugged in
  std::mutex mutex;
  std::vector<Force> forces;     ///< that it was told, in order
  std::vector<int> descriptors;  ///< that it was opened with
};
Rails& rails();

}  // namespace wale::made_up

namespace wale {

extern const Driver made_up_driver;

}  // namespace wale
