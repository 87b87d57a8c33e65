#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "calibration/experiment/run_experiment.hpp"
#include "compiler/compile_experiment.hpp"
#include "compiler/diagnostics/render.hpp"

namespace wale::experiments_test {

/// A material with an amplitude and a period, and an experiment with these settings.
inline std::string design(const std::string& settings) {
  return "wale 1\n"
         "material bench {\n  physical {\n    param amplitude = 0.8 N in 0 N .. 4 N\n"
         "    param period = 2.5 mm in 0.7 mm .. 10 mm\n"
         "    force = lateral(grating(x, period: period), amplitude: amplitude)\n  }\n}\n"
         "material smooth { physical { force = lateral(cos(x / 1 mm), amplitude: 0.1 N) } }\n"
         "experiment test {\n" +
         settings + "\n}\n";
}

/// The messages about a text, checked.
inline std::vector<std::string> messages_of(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  check_source(sources, sources.add("test.wale", text), *resolver, diagnostics);
  std::vector<std::string> messages;
  for (const auto& each : diagnostics.all()) messages.push_back(each.message);
  return messages;
}

/// A checked text without errors, and its first experiment.
struct Design {
  SourceSet sources;
  Diagnostics diagnostics;
  std::unique_ptr<Resolver> resolver = file_resolver({});
  SourceId source;
  CheckedModule module;

  explicit Design(const std::string& text, const std::string& file = "test.wale") : source(sources.add(file, text)) {
    module = check_source(sources, source, *resolver, diagnostics);
    for (const auto& each : diagnostics.all())
      if (severity_of(each.code) == Severity::error) ADD_FAILURE() << render_text(each, sources, false);
    if (module.experiments.empty()) throw std::runtime_error("no experiment");
  }
  const CheckedExperiment& experiment(const std::string& name = {}) const { return *module.experiment(name); }

  MadeExperiment made(const std::string& name = {}) const {
    return compile_experiment(experiment(name), module, default_device, sources, source, *resolver);
  }
  ReadyExperiment ready(const std::string& name = {}) const {
    ReadyExperiment ready;
    ready.experiment = &experiment(name);
    ready.text = sources[source].text;
    MadeExperiment all = made(name);
    EXPECT_TRUE(all.is_whole());
    for (MadeStimulus& each : all.stimuli) ready.stimuli.push_back(*std::move(each.program));
    for (MadeStimulus& each : all.standards) ready.standards.push_back(*std::move(each.program));
    return ready;
  }
};

/// Presents nothing: what is felt is said beforehand, by the place of the program among all stimuli and then standards.
class Numbers final : public Presenter {
 public:
  Numbers(const ReadyExperiment& ready, std::vector<double> sizes) : ready_(ready), sizes_(std::move(sizes)) {}
  std::string recording_of(const Program&, const std::string&) override { return {}; }
  Result<FeltSize> present(const Program& program, const std::string&) override {
    ++presented;
    for (std::size_t i = 0; i < ready_.stimuli.size() + ready_.standards.size(); ++i) {
      const Program& each = i < ready_.stimuli.size() ? ready_.stimuli[i] : ready_.standards[i - ready_.stimuli.size()];
      if (&each == &program) return FeltSize{{sizes_.at(i), sizes_.at(i), 30}, {sizes_.at(i), sizes_.at(i), 30}, 0.1, true};
    }
    return Error{.code = Code::malformed_value, .sentence = "no such program"};
  }
  std::size_t presented = 0;

 private:
  const ReadyExperiment& ready_;
  std::vector<double> sizes_;
};

/// Answers with these lines, one after the other, then ends the session.
class Scripted final : public Participant {
 public:
  explicit Scripted(std::vector<std::string> lines) : lines_(std::move(lines)) {}
  void begin(const Trial& trial, std::size_t, int, int) override { trials.push_back(trial); }
  void felt(const Presented&, const FeltSize&) override {}
  Result<std::string> say(const Question&) override {
    if (next_ == lines_.size()) return Error{.code = Code::stopped, .sentence = "no more lines"};
    return lines_[next_++];
  }
  void refuse(const std::string& why) override { refusals.push_back(why); }
  void tell(const std::string&) override {}

  std::vector<std::string> refusals;
  std::vector<Trial> trials;

 private:
  std::vector<std::string> lines_;
  std::size_t next_ = 0;
};

}  // namespace wale::experiments_test
