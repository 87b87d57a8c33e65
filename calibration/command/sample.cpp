#include "compiler/measure/sample.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/command/options.hpp"
#include "runtime/device/simulated/load_trace.hpp"

namespace wale::command {
namespace {

struct SampleOptions {
  Choice choice;
  std::vector<std::string> settings;
  std::optional<Hand> at;  ///< set if `trace` is empty
  std::string trace;
  std::string out = "-";
  bool json = false;
};

Result<std::vector<SampledHand>> hands_of(const SampleOptions& options) {
  std::vector<SampledHand> hands;
  if (options.at) {
    hands.push_back({0, *options.at});
    return hands;
  }
  options.choice.inputs->push_back(options.trace);
  const auto trace = load_trace(options.trace);
  if (!trace) return trace.error();
  for (const TracePoint& point : trace->points)
    hands.push_back({point.time, {glm::vec2(point.position), glm::vec2(point.velocity)}});
  return hands;
}

int sample(const SampleOptions& options) {
  if (!options.at && options.trace.empty())
    return refuse(Error{.code = Code::missing_argument,
                        .sentence = "expected a hand, found none",
                        .mend = "for example, `--at \"10.6 mm, 5 mm\"`, or `--trace FILE`",
                        .place = {.name = "--at"}});
  const auto programs = load_programs(options.choice, false);
  if (!programs) return programs.status();
  const Program& program = programs->front();
  const auto parameters = chosen_parameters(program, options.settings);
  if (!parameters) return refuse(parameters.error());
  const auto hands = hands_of(options);
  if (!hands) return refuse(hands.error());
  const auto samples = wale::sample(Bank(program, *parameters, program.default_size()), *hands);
  const bool vibrates = program.description().vibrates();
  const std::string text = options.json ? samples_json(samples, vibrates) : samples_csv(samples, vibrates);
  if (const auto written = write_file(options.out, text, *options.choice.inputs); !written)
    return refuse(written.error());
  return done;
}

Run declare_sample(CLI::App& verb) {
  const auto options = std::make_shared<SampleOptions>();
  offer_material(verb, options->choice);
  offer_settings(verb, options->settings);
  auto* at = offer_hand(verb, "--at", options->at,
                        "one hand from the patch's centre: \"10 mm, 5 mm[, 0.1 m/s, 0 m/s]\"; or give --trace");
  verb.add_option("--trace", options->trace,
                  "a CSV file with t (s), x, y (m), and optionally vx, vy (m/s); each line is a tick")
      ->type_name("FILE")
      ->excludes(at);
  offer_output(verb, options->out, "where to write (default: standard output)");
  offer_json(verb, options->json, "a JSON array instead of CSV");
  verb.footer("for example: wale sample corduroy --at \"10.6 mm, 5 mm\"");
  return [options] { return sample(*options); };
}

}  // namespace

extern const Verb sample_verb{
    "sample", "prints a program's force at given positions of the hand, open loop; outside the patch it is 0",
    declare_sample};

}  // namespace wale::command
