#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

#include "wale/recording.hpp"

namespace wale {
namespace {

/// One line of cells. A number has the fewest digits that read back as the same number, in any locale; not-a-number
/// gives an empty cell.
class Line {
 public:
  explicit Line(std::ostream& out) : out_(out) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> Line& operator<<(Number number) {
    if (std::isnan(static_cast<double>(number))) return *this << std::string_view();
    if (number == Number{0}) number = Number{0};  // no -0
    std::array<char, 32> digits;
    const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    return *this << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
  }
  Line& operator<<(std::string_view text) {
    if (!first_) out_ << ',';
    first_ = false;
    out_ << text;
    return *this;
  }
  Line& operator<<(glm::vec2 pair) { return *this << pair.x << pair.y; }

 private:
  std::ostream& out_;
  bool first_ = true;
};

void write_header(std::ostream& out, bool vibrates) {
  out << "t (s),x (m),y (m),vx (m/s),vy (m/s),"
      << (vibrates ? "amplitude (m/s^2),frequency (Hz)" : "force x (N),force y (N)")
      << ",interaction x (N),interaction y (N),lateness (s),skipped (periods),inside";
}

Line& operator<<(Line& line, const TickRecord& tick) {
  return line << tick.time << tick.position << tick.velocity << tick.force << tick.interaction << tick.lateness
              << tick.skipped << (tick.inside ? 1 : 0);
}

constexpr std::array<std::pair<GuardBit, std::string_view>, 11> guard_words{{{GuardBit::not_a_number, "not-a-number"},
                                                                             {GuardBit::device_limit, "device limit"},
                                                                             {GuardBit::user_limit, "user limit"},
                                                                             {GuardBit::energy, "energy"},
                                                                             {GuardBit::passivity, "passivity"},
                                                                             {GuardBit::slew, "slew"},
                                                                             {GuardBit::overrun, "overrun"},
                                                                             {GuardBit::stale, "stale"},
                                                                             {GuardBit::lost, "lost"},
                                                                             {GuardBit::restored, "restored"},
                                                                             {GuardBit::heat, "heat"}}};

std::string guards_in_words(std::uint32_t guards) {
  std::string words;
  for (const auto& [bit, word] : guard_words)
    if ((guards & static_cast<std::uint32_t>(bit)) != 0) words += (words.empty() ? "" : " + ") + std::string(word);
  return words;
}

constexpr std::array<std::string_view, 3> contact_words{"good", "stale", "lost"};

}  // namespace

void write_csv(std::ostream& out, const Record& record) {
  write_header(out, record.vibrates);
  out << '\n';
  for (const TickRecord& tick : record.ticks) {
    Line line(out);
    line << tick;
    out << '\n';
  }
}

void write_csv(std::ostream& out, const Recording& recording) {
  const DeviceProfile& device = recording.header().device;
  const bool vibrates = device.shaker.has_value();
  const double seconds_per_tick = 1 / device.rate;  // the same bits as in the run's `Record`
  write_header(out, vibrates);
  out << ",counts x,counts y,"
      << (vibrates
              ? "program amplitude (m/s^2),program frequency (Hz),commanded amplitude (m/s^2),commanded frequency (Hz)"
              : "program force x (N),program force y (N),commanded force x (N),commanded force y (N)")
      << ",patch,revision,contact,button,guards\n";
  for (std::size_t i = 0; i < recording.ticks(); ++i) {
    const RecordedTick tick = recording.tick(i);
    Line line(out);
    line << TickRecord{.time = static_cast<double>(tick.period) * seconds_per_tick,
                       .position = glm::vec2(glm::dvec2(tick.counts) * device.position_step()),
                       .velocity = tick.velocity,
                       .force = tick.force,
                       .interaction = tick.interaction,
                       .lateness = static_cast<float>(static_cast<double>(tick.lateness) * 1e-9),
                       .skipped = tick.skipped,
                       .inside = tick.inside};
    line << tick.counts.x << tick.counts.y << tick.wanted << tick.commanded;
    if (tick.patch == RecordedTick::no_patch)
      line << std::string_view();
    else
      line << tick.patch;
    line << tick.revision << contact_words[static_cast<std::size_t>(tick.contact)] << (tick.button ? 1 : 0)
         << guards_in_words(tick.guards);
    out << '\n';
  }
}

}  // namespace wale
