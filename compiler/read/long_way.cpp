#include "compiler/read/long_way.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "compiler/read/dependence.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr double probing = 0.1, faster = 0.2;  // m/s
constexpr double inside = 0.98;                // of the patch without its rim
constexpr double bin = 1.5e-3, least_bins = 6;  // m, over which a force is averaged, and of the way
constexpr double grown = 0.97;                 // of its size
constexpr double all_of_it = 0.999;            // of the device's limit
constexpr double growing = 1.01;               // times what it was some bins before
constexpr std::size_t some_bins = 3;
constexpr double long_enough = 0.015, times_as_long = 4;  // m, and of the path: it will not grow more
constexpr double alike_at_speeds = 0.05;                  // relative
constexpr double given_back = 0.1;  // of the force on the way forth, by which that on the way back may differ

/// The force against hands that go both ways along an axis, beyond what they would feel if they had just come: its
/// means over bins of the way.
class LongStroke {
 public:
  LongStroke(const Bank& bank, const Room& room, glm::dvec2 way, double speed)
      : bank_(bank), own_(bank), speed_(speed), rate_(bank.program().description().device.rate) {
    const double length = 2 * inside * reach_within(half_of(bank), {0, 0}, way);
    for (const glm::dvec2 each : {way, -way}) {
      const glm::dvec2 middle = room.nearest({{0, 0}, each, 0.5 * length, 0.5 * length});
      from_.push_back(middle - 0.5 * length * each), ways_.push_back(each);
      memories_.emplace_back(own_.program());
    }
    a_bin_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::min(bin, length / least_bins) / speed * rate_));
    bins_ = static_cast<std::size_t>(length / speed * rate_) / a_bin_;
  }

  double width() const { return static_cast<double>(a_bin_) * speed_ / rate_; }
  bool ends() const { return next_ >= bins_; }

  /// The mean over the next bin, N.
  double go_on() { return mean_over(next_++, true); }

  /// Whether what is remembered stayed on the way forth, and the hands feel the same on the way back over the same
  /// places as on the way forth, whose means these are: then a spring holds them to a place, and no friction takes
  /// their energy. A bristle that is longer than the patch gives all back too, but is still bending.
  bool gives_back(const std::vector<double>& means) {
    for (std::size_t k = 0; k < ways_.size(); ++k)
      if (!std::ranges::equal(memories_[k].states(), entered_[k])) return false;
    double size = 0, apart = 0;
    for (const double each : means) size += std::abs(each);
    for (std::size_t back = means.size(); back-- > 0 && apart <= given_back * size;)
      apart += std::abs(mean_over(back, false) - means[back]);
    return apart <= given_back * size;
  }

 private:
  double mean_over(std::size_t number, bool forth) {
    std::vector<Hand> fresh;
    std::vector<Force> felt;
    for (std::size_t i = 0; i < a_bin_; ++i, ++now_)
      for (std::size_t k = 0; k < ways_.size(); ++k) {
        const double seconds = static_cast<double>(number * a_bin_ + (forth ? i : a_bin_ - 1 - i)) / rate_;
        Hand& hand = fresh.emplace_back();
        hand.position = hand.workspace = glm::vec2(from_[k] + seconds * speed_ * ways_[k]);
        hand.velocity = hand.raw_velocity = glm::vec2((forth ? speed_ : -speed_) * ways_[k]);
        hand.time = static_cast<double>(now_) / rate_;
        if (now_ == 0) {
          memories_[k].enter(own_, hand);
          entered_.emplace_back(memories_[k].states().begin(), memories_[k].states().end());
        }
        felt.push_back(tick(own_, memories_[k], hand));
      }
    std::vector<Force> unheld(fresh.size());
    tick_all(bank_, fresh, unheld);
    double sum = 0;
    for (std::size_t i = 0; i < fresh.size(); ++i)
      sum -= glm::dot(glm::dvec2(felt[i] - unheld[i]), ways_[i % ways_.size()]);
    return sum / static_cast<double>(fresh.size());
  }

  const Bank& bank_;
  Bank own_;
  double speed_, rate_;
  std::vector<glm::dvec2> from_, ways_;
  std::vector<Memory> memories_;
  std::vector<std::vector<float>> entered_;  ///< what they remembered when the hands had come
  std::size_t a_bin_ = 1, bins_ = 0, next_ = 0, now_ = 0;
};

/// Where the means come to the last of them.
LongWay told_by_means(const std::vector<double>& means, double width, double most) {
  LongWay found;
  const std::size_t count = means.size();
  if (count <= some_bins) return found;
  const double last = std::accumulate(means.end() - some_bins, means.end(), 0.0) / some_bins;
  const auto whole = std::ranges::find_if(means, [&](double each) { return each >= grown * last; });
  found.path = static_cast<double>(whole - means.begin() + 1) * width;
  found.grows = last >= least_force && means.back() > growing * means[count - 1 - some_bins];
  found.force = found.grows ? means.back() : last;
  if (found.force < least_force) return {};
  // How far a bristle still bends that pulls with all that the device gives is not felt, but where it turns about.
  found.cut = found.force >= all_of_it * most;
  return found;
}

LongWay long_way_along(const Bank& bank, const Room& room, glm::dvec2 way, double speed) {
  LongStroke stroke(bank, room, way, speed);
  std::vector<double> means;
  const double most = bank.program().description().device.most();
  while (!stroke.ends()) {
    means.push_back(stroke.go_on());
    const double gone = static_cast<double>(means.size()) * stroke.width();
    if (gone < long_enough) continue;
    const LongWay found = told_by_means(means, stroke.width(), most);
    if (!found.grows && gone > times_as_long * found.path) break;
  }
  const LongWay found = told_by_means(means, stroke.width(), most);
  return found.path > usual_path && stroke.gives_back(means) ? LongWay{} : found;
}

}  // namespace

std::array<LongWay, 2> long_ways(const Bank& bank, const Room& room) {
  const PatchProgram& program = bank.program().description();
  if (program.states.empty() || !program.grids.empty() || remembers_time_only(program)) return {};
  std::array<LongWay, 2> found;
  for (const std::size_t axis : {0, 1}) {
    const glm::dvec2 way = axis == 0 ? glm::dvec2(1, 0) : glm::dvec2(0, 1);
    found[axis] = long_way_along(bank, room, way, probing);
    if (found[axis].path <= usual_path) continue;
    // What comes with time, as a drag behind a filter, takes a longer way at a higher speed, and is another force
    // there.
    const LongWay other = long_way_along(bank, room, way, faster);
    if (std::abs(other.force - found[axis].force) > alike_at_speeds * found[axis].force) found[axis] = {};
  }
  return found;
}

}  // namespace wale
