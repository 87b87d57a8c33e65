// An example driver, for hardware that does not exist. It is added by this folder and one row of a table.
#include <string>
#include <utility>
#include <vector>

#include "tests/device/made_up/made_up.hpp"

namespace wale {
namespace {

class RailsDevice final : public PluggedDevice {
 public:
  explicit RailsDevice(DeviceProfile profile) : profile_(std::move(profile)) { ++made_up::rails().open; }
  ~RailsDevice() override { --made_up::rails().open; }

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override {
    const made_up::Rails& rails = made_up::rails();
    Reading reading;
    reading.counts = {rails.x.load(), rails.y.load()};
    was_lost_ = was_lost_ || !rails.is_plugged_in;
    reading.contact = was_lost_ ? Contact::lost : Contact::good;
    return reading;
  }
  Force command(Force force) noexcept override {
    const std::lock_guard lock(made_up::rails().mutex);
    made_up::rails().forces.push_back(force);
    return force;
  }
  std::string reason() const override { return was_lost_ ? "it came off its rails" : ""; }
  std::vector<std::pair<std::string, long>> tally() const override {
    return {{"forces_told", static_cast<long>(made_up::rails().forces.size())}};
  }
  std::string manner() const override { return "on rails"; }

 private:
  DeviceProfile profile_;
  std::atomic<bool> was_lost_{false};
};

std::vector<PluggedIn> find_made_up(const Connections&, const PluggedIn*) {
  ++made_up::rails().looks;
  if (!made_up::rails().is_plugged_in) return {};
  return {{.driver = &made_up_driver,
           .port = "rails",
           .name = "Handle on rails",
           .can = "two axes",
           .profile = "handle_on_rails"}};
}

OpenedDevice open_made_up(const Connections&, const PluggedIn&, const TrustedDevice& trusted,
                          const DeviceOptions& options) {
  if (!made_up::rails().is_plugged_in) return Error{Code::absent_device, "it is off its rails"};
  const std::lock_guard lock(made_up::rails().mutex);
  made_up::rails().descriptors.push_back(options.descriptor);
  return std::make_unique<RailsDevice>(trusted.profile());
}

}  // namespace

const Driver made_up_driver{
    .name = "made-up", .is_chosen_by_auto = true, .is_felt = true, .find = find_made_up, .open = open_made_up};

made_up::Rails& made_up::rails() {
  static Rails rails;
  return rails;
}

}  // namespace wale
