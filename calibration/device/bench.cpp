#include "calibration/device/bench.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace wale {
namespace {

constexpr double rise_seconds = 0.5;    // s, to the full command and back
constexpr double share_of_room = 0.08;  // of the workspace's diameter, in which the handle is shaken
constexpr double share_of_push = 0.35;  // of the force that shakes; the rest draws the handle back to the middle
constexpr double level_seconds = 3;     // s at each of the levels
constexpr double settling_seconds = 1.5, braking_seconds = 0.15;
constexpr std::array shake_levels{0.4, 0.7, 1.0};
constexpr std::array half_periods{0.12, 0.2, 0.16};        // s; different ones tell damping from friction
constexpr double gauge_noise = 0.002, gauge_zero = 0.004;  // of the device's force: a simulated gauge's

}  // namespace

Result<Bench::Tick> Bench::tick(int axis, double command) {
  using Clock = std::chrono::steady_clock;
  device_.elapse(1);
  const Reading reading = device_.sample();
  if (stop_.load(std::memory_order_relaxed)) {
    let_go();
    return Error{Code::stopped, "stopped while the device was measured"};
  }
  if (reading.contact == Contact::lost) {
    let_go();
    return Error{Code::lost_device, "the device was lost while it was measured"};
  }
  if (last_)
    for (std::size_t i = 0; i < 2; ++i) {
      const int moved = std::abs(reading.counts[static_cast<int>(i)] - (*last_)[static_cast<int>(i)]);
      if (moved > 0 && (smallest_steps_[i] == 0 || moved < smallest_steps_[i])) smallest_steps_[i] = moved;
    }
  last_ = reading.counts;
  Force force(0);
  const double gain = gain_[static_cast<std::size_t>(axis)];
  force[axis] = static_cast<float>(command * gain);
  const Force exerted = device_.command(reading.contact == Contact::good ? force : Force(0));
  if (!is_virtual_) {
    const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / profile().rate));
    next_ = std::max(next_ + period, Clock::now());  // a late tick is not caught up
    std::this_thread::sleep_until(next_);
  }
  return Tick{reading.counts, exerted[axis] / gain};
}

Result<double> Bench::push(Way way, double command, double seconds) {
  const int axis = axis_of(way);
  const auto ticks_of = [&](double time) { return std::max(1L, std::lround(time * profile().rate)); };
  const long rise = ticks_of(std::min(rise_seconds, seconds)), hold = ticks_of(seconds);
  double taken = 0;
  for (long i = 0; i < 2 * rise + hold; ++i) {
    const double share = std::min({1.0, static_cast<double>(i + 1) / static_cast<double>(rise),
                                   static_cast<double>(2 * rise + hold - i) / static_cast<double>(rise)});
    const auto done = tick(axis, sign_of(way) * share * command);
    if (!done) return done.error();
    if (share == 1) taken = done->command * sign_of(way);
  }
  let_go();
  return std::max(0.0, taken);
}

Result<RestNoise> Bench::rest(double seconds) {
  glm::dvec2 sum(0), squares(0);
  const long ticks = std::max(2L, std::lround(seconds * profile().rate));
  glm::ivec2 first(0);
  for (long i = 0; i < ticks; ++i) {
    const auto done = tick(0, 0);
    if (!done) return done.error();
    if (i == 0) first = done->counts;
    const glm::dvec2 moved(done->counts - first);
    sum += moved;
    squares += moved * moved;
  }
  const auto n = static_cast<double>(ticks);
  RestNoise noise;
  for (int axis = 0; axis < 2; ++axis)
    noise.deviation[static_cast<std::size_t>(axis)] =
        std::sqrt(std::max(0.0, squares[axis] - sum[axis] * sum[axis] / n) / (n - 1));
  return noise;
}

Result<std::vector<HandleTick>> Bench::shake(int axis, double most_newton, const AxisResponse& response) {
  const double seconds = 1 / profile().rate, room = share_of_room * profile().workspace_diameter;
  std::vector<HandleTick> ticks;
  double position = 0, start = 0;
  for (const double level : shake_levels) {
    const double push = level * share_of_push * most_newton;
    double until = 0, time = 0;
    std::size_t half = 0;
    for (double sign = 1; time < level_seconds; time += seconds) {
      if (time >= until) {
        until += half_periods[half++ % half_periods.size()];
        sign = -sign;
      }
      const double drawn = -std::clamp((position - start) / room, -1.0, 1.0) * (1 - share_of_push) * most_newton;
      const auto done = tick(axis, response.command(sign * push + drawn));
      if (!done) return done.error();
      position = done->counts[axis] * profile().position_step();
      if (ticks.empty()) start = position;
      // What the tick reports is where the handle was when it was told this command.
      ticks.push_back({position, response.force(done->command)});
    }
  }
  // It is brought to rest, so that the other axis begins in the middle too.
  double before = position;
  for (double time = 0; time < settling_seconds; time += seconds) {
    const double speed = (position - before) / seconds;
    before = position;
    const double drawn = (position - start) / room + speed / (room / braking_seconds);
    const auto done = tick(axis, response.command(-std::clamp(drawn, -1.0, 1.0) * most_newton));
    if (!done) return done.error();
    position = done->counts[axis] * profile().position_step();
  }
  let_go();
  return ticks;
}

PlantedDevice::PlantedDevice(const DeviceProfile& profile, const DeviceWiring& truth, std::uint64_t seed)
    : truth_{truth.response_of(0, profile.force_newton), truth.response_of(1, profile.force_newton)},
      joystick_(profile, HandModel{}, Rest{}),
      random_(seed) {}

Force PlantedDevice::command(Force force) noexcept {
  const double peak = profile().force_newton, step = profile().force_step();
  Force taken(0), exerted(0);
  for (int axis = 0; axis < 2; ++axis) {
    const double steps = std::isnan(force[axis]) ? 0 : std::round(std::clamp<double>(force[axis], -peak, peak) / step);
    taken[axis] = static_cast<float>(steps * step);
    exerted[axis] = static_cast<float>(truth_[static_cast<std::size_t>(axis)].force(steps * step));
  }
  joystick_.command(exerted);
  return taken;
}

double PlantedDevice::gauge(Way way, double command) {
  const double peak = profile().force_newton;
  const double force = sign_of(way) * truth_[static_cast<std::size_t>(axis_of(way))].force(sign_of(way) * command);
  return force + peak * (gauge_zero + gauge_noise * random_.normal());
}

}  // namespace wale
