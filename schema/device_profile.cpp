#include "wale/device_profile.hpp"

#include <algorithm>

namespace wale {
namespace {

/// The y at `x` on the straight line from (x0, y0) to (x1, y1), x1 > x0.
double between_points(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
}

double acceleration_at(const Shaker::Response& response, double command) {
  double x = 0, y = 0;
  for (const auto& point : response.points) {
    if (command < point.command) return between_points(command, x, y, point.command, point.acceleration);
    x = point.command, y = point.acceleration;
  }
  return y;
}

/// Interpolates `at` linearly between the responses on either side of a frequency.
template <typename At>
double at_frequency(const std::vector<Shaker::Response>& response, double frequency, At at) {
  if (response.empty()) return 0;
  if (!(frequency > response.front().frequency)) return at(response.front());
  for (std::size_t i = 1; i < response.size(); ++i)
    if (frequency < response[i].frequency)
      return between_points(frequency, response[i - 1].frequency, at(response[i - 1]), response[i].frequency,
                            at(response[i]));
  return at(response.back());
}

}  // namespace

double Shaker::peak() const {
  double most = 0;
  for (const Response& each : response)
    for (const auto& point : each.points) most = std::max(most, point.acceleration);
  return most;
}

double Shaker::acceleration(double command, double frequency) const noexcept {
  return at_frequency(response, frequency, [&](const Response& each) { return acceleration_at(each, command); });
}

double Shaker::command(double acceleration, double frequency) const noexcept {
  // Between two frequencies the curve is a mean of two piecewise linear ones, which bends at the commands of both. Find
  // the bends on either side of the request.
  double below = 0, above = 1, least = 0, most = this->acceleration(1, frequency);
  if (!(acceleration < most)) return 1;
  for (const Response& each : response)
    for (const auto& point : each.points) {
      const double given = this->acceleration(point.command, frequency);
      if (given <= acceleration && point.command > below) below = point.command, least = given;
      if (given > acceleration && point.command < above) above = point.command, most = given;
    }
  return acceleration > least ? between_points(acceleration, least, below, most, above) : below;
}

}  // namespace wale
