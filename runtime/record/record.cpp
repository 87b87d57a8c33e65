#include "wale/record.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string_view>

namespace wale {
namespace {

/// One line of cells. Numbers in the shortest digits that read back the same, independent of any locale.
class Line {
 public:
  explicit Line(std::ostream& out) : out_(out) {}

  template <class Number>
  Line& operator<<(Number number) {
    if (!first_) out_ << ',';
    first_ = false;
    if (std::isnan(static_cast<double>(number))) return *this;
    std::array<char, 32> digits;
    const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    out_ << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
    return *this;
  }

  Line& operator<<(glm::vec2 pair) { return *this << pair.x << pair.y; }

 private:
  std::ostream& out_;
  bool first_ = true;
};

}  // namespace

void write_csv(std::ostream& out, const Record& record) {
  out << "t (s),x (m),y (m),vx (m/s),vy (m/s),"
      << (record.vibrates ? "amplitude (m/s^2),frequency (Hz)" : "force x (N),force y (N)")
      << ",interaction x (N),interaction y (N),lateness (s),skipped (periods),inside\n";
  for (const TickRecord& tick : record.ticks) {
    Line(out) << tick.time << tick.position << tick.velocity << tick.force << tick.interaction << tick.lateness
              << tick.skipped << (tick.inside ? 1 : 0);
    out << '\n';
  }
}

}  // namespace wale
