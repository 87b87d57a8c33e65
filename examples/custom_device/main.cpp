// A device that Wale has no driver for: its figures are declared in Wale, so that shipped materials are compiled for it by
// their names, and a class reads its handle and pushes it. Here the handle is a mass on a spring that was pulled aside.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <wale/wale.hpp>

namespace {

constexpr const char* declared = R"(wale 1

export device rail_stick {
  class     force_plane
  workspace disc(100 mm)
  position  8192 counts
  force     4 N, 1000 counts
  rate      1000 Hz
  speed     assumed 1 m/s
  slew      assumed 100 N/s
  velocity_filter 15, 1 counts
  patch     80 mm, 80 mm, 5 mm
  mass      assumed 0.1 kg
  damping   assumed 1 N s/m
  friction  assumed 0.05 N
  delay     assumed 1 ms
  sustained unknown
  active    assumed 1 W
  source    "the maker's data sheet"
}
)";

class RailStick final : public wale::Device {
 public:
  explicit RailStick(wale::DeviceProfile profile) : profile_(std::move(profile)) {}

  const wale::DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override {
    constexpr double mass = 0.1, spring = 40;  // kg, N/m
    const double seconds = static_cast<double>(periods) / profile_.rate;
    velocity_ += (force_ - spring * place_) / mass * seconds;
    place_ += velocity_ * seconds;
  }
  wale::Reading sample() noexcept override {
    wale::Reading reading;
    reading.counts = {static_cast<int>(place_ / profile_.position_step()), 0};
    return reading;
  }
  wale::Force command(wale::Force force) noexcept override {
    const auto most = static_cast<float>(profile_.force_newton);
    force_ = std::clamp(force.x, -most, most);
    return {static_cast<float>(force_), 0};
  }
  double place() const { return place_; }

 private:
  wale::DeviceProfile profile_;
  double place_ = 0.03, velocity_ = 0, force_ = 0;  // m, m/s, N
};

}  // namespace

int failed(const wale::Error& error) {
  std::fprintf(stderr, "%s\n", wale::in_words(error).c_str());
  return 1;
}

int main() {
  const wale::Library library({.devices = declared});
  const auto corduroy = library.find("corduroy", {.device = "rail_stick"});
  const auto syrup = library.compile("wale 1\nmaterial syrup { physical { force = -2 N s/m * velocity } }",
                                     {.device = "rail_stick"});
  if (!corduroy) return failed(corduroy.error());
  if (!syrup) return failed(syrup.error());
  RailStick stick(syrup->program.description().device);
  wale::Stage stage(stick);
  auto patch = stage.add(corduroy->program);
  if (!patch) return failed(patch.error());
  const auto on_corduroy = stage.run({.seconds = 0.2, .virtual_time = true});
  if (!on_corduroy) return failed(on_corduroy.error());
  std::printf("corduroy was felt on %ld ticks\n",
              static_cast<long>(std::ranges::count_if(on_corduroy->record.ticks, [](const wale::TickRecord& tick) {
                return tick.inside && tick.force != wale::Force(0);
              })));
  if (auto replaced = patch->replace(syrup->program); !replaced) return failed(replaced.error());
  const auto run = stage.run({.seconds = 2, .virtual_time = true});
  if (!run) return failed(run.error());
  std::printf("after 2 s in syrup the handle is %.1f mm from the middle\n", 1000 * stick.place());
  return std::abs(stick.place()) < 0.003 ? 0 : 1;
}
