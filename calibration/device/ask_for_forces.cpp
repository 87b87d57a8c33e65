#include "calibration/device/ask_for_forces.hpp"

#include <array>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

constexpr std::array command_shares{0.0, 0.02, 0.04, 0.07, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

/// A line without the blanks at its end; nothing at the end of the input.
std::optional<std::string> take_line(std::istream& in) {
  std::string line;
  if (!std::getline(in, line)) return std::nullopt;
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.pop_back();
  return line;
}

/// The first step of the next way.
std::size_t next_way(std::span<const GaugeStep> steps, std::size_t at) {
  const Way way = steps[at].way;
  while (at < steps.size() && steps[at].way == way) ++at;
  return at;
}

}  // namespace

std::vector<GaugeStep> force_steps(double most) {
  std::vector<GaugeStep> steps;
  for (const Way way : all_ways) {
    for (const double share : command_shares) steps.push_back({way, share * most, 1});
    for (auto share = command_shares.rbegin(); share != command_shares.rend(); ++share)
      steps.push_back({way, *share * most, 2});
  }
  return steps;
}

Result<GaugeReadings> ask_for_forces(std::span<const GaugeStep> steps, std::istream& in, std::ostream& out,
                                     const std::function<Result<double>(const GaugeStep&)>& push) {
  std::vector<std::pair<std::size_t, GaugeReading>> taken;  // by their steps
  std::string unit;
  const Error ended{.code = Code::stopped, .sentence = "ended before all readings were taken"};
  for (std::size_t at = 0; at < steps.size();) {
    const GaugeStep& step = steps[at];
    out << readable("\n{} of {}: {}, along {}, round {}, command {:.4g} N\n", at + 1, steps.size(), in_words(step.way),
                    axis_of(step.way) == 0 ? "x" : "y", step.repeat, step.command)
        << "hold the gauge against the handle; Enter pushes (back, skip, q): " << std::flush;
    auto word = take_line(in);
    if (!word || *word == "q") return ended;
    if (*word == "skip") {
      at = next_way(steps, at);
      continue;
    }
    if (*word == "back") {
      if (taken.empty()) {
        out << "there is no answer to take back\n";
      } else {
        at = taken.back().first;
        out << readable("taken back: {} at {:.4g} N, {:.4g} N\n", in_words(taken.back().second.way),
                        taken.back().second.command, taken.back().second.newton);
        taken.pop_back();
      }
      continue;
    }
    const auto command = push(step);
    if (!command) return command.error();
    for (;;) {
      out << "the gauge showed (as in 2.31 N; again, back): " << std::flush;
      word = take_line(in);
      if (!word || *word == "q") return ended;
      if (*word == "again" || *word == "back") break;
      const auto reading = read_gauge_quantity(*word, unit, false);
      if (!reading) {
        out << visible_lines(reading.error().sentence + "; " + reading.error().mend) << '\n';
        continue;
      }
      unit = reading->unit;
      taken.push_back({at, {step.way, *command, reading->value, step.repeat, 0}});
      ++at;
      break;
    }
  }
  GaugeReadings all;
  for (const auto& each : taken) all.readings.push_back(each.second);
  return all;
}

}  // namespace wale
