#include "tests/truth/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <span>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/reading_of.hpp"

namespace wale::truth {
namespace {

void add(Score& score, const Case& made, const Judgement& judgement) {
  ++score.programs;
  if (judgement.right()) ++score.right;
  if (judgement.invents) ++score.inventing;
  Fault fault{made.name, "", made.source, 0};
  for (std::size_t i = 0; i < judged_count; ++i) {
    Score::OfCue& cue = score.cues[i];
    if (judgement.verdicts[i] == Verdict::open) continue;
    ++cue.judged;
    const bool is_sized = i < cue_count        ? made.truth.cues[i].kind == Expected::Kind::value
                          : i == cue_count     ? !made.truth.waves->empty()
                          : i == cue_count + 1 ? !made.truth.walls->empty()
                                               : !made.truth.steps->empty();
    if (is_sized) ++cue.sized;
    if (judgement.verdicts[i] == Verdict::right) {
      ++cue.right;
      if (is_sized) ++cue.sized_right;
      continue;
    }
    fault.faults += fmt::format("  {}: {}\n", judged_name(i), judgement.faults[i]);
    fault.error = std::max(fault.error, judgement.errors[i]);
    if (judgement.errors[i] <= cue.worst) continue;
    cue.worst = judgement.errors[i];
    cue.worst_fault = made.name + ": " + judgement.faults[i];
  }
  if (!judgement.right()) score.faults.push_back(std::move(fault));
}

using Count = std::pair<std::size_t, std::size_t>;

/// A bar, and the classes below it.
std::string bar(const char* what, double least, const std::vector<Score>& scores,
                const std::function<Count(const Score&)>& count) {
  std::size_t right = 0, all = 0;
  std::string below;
  for (const Score& score : scores) {
    const auto [of_these, judged] = count(score);
    right += of_these, all += judged;
    if (static_cast<double>(of_these) < least * static_cast<double>(judged))
      below += fmt::format("\n    {} {} of {}", score.family, of_these, judged);
  }
  const double share = all == 0 ? 1 : static_cast<double>(right) / static_cast<double>(all);
  return fmt::format("{}: {} of {}, {:.1f} %; the bar is {:.0f} %: {}{}\n", what, right, all, 100 * share, 100 * least,
                     share >= least ? "met" : "not met", below.empty() ? "" : "\n  below it are" + below);
}

/// Of the programs that have these cues.
Count of_sized(const Score& score, std::span<const Cue> cues) {
  Count count;
  for (const Cue cue : cues) {
    count.first += score.cues[static_cast<std::size_t>(cue)].sized_right;
    count.second += score.cues[static_cast<std::size_t>(cue)].sized;
  }
  return count;
}

}  // namespace

Score score_of(const Family& family, std::size_t count) {
  Score score;
  score.family = family.name;
  for (std::size_t i = 0; i < count; ++i) {
    const Case made = generated(family, i);
    add(score, made, judge(made.truth, reading_of(compiling::Compiled(made.source).only())));
  }
  return score;
}

std::string table_of(const std::vector<Score>& scores) {
  std::string text = fmt::format("{:<20}{:>9}{:>7}{:>9}", "class", "programs", "right", "invents");
  for (std::size_t i = 0; i < judged_count; ++i) text += fmt::format(" {:>11}", judged_name(i));
  for (const Score& score : scores) {
    text += fmt::format("\n{:<20}{:>9}{:>7}{:>9}", score.family, score.programs, score.right, score.inventing);
    for (const Score::OfCue& cue : score.cues)
      text += fmt::format(" {:>11}", cue.judged == 0 ? "-" : fmt::format("{}/{}", cue.right, cue.judged));
  }
  return text + "\n";
}

std::string worst_of(const std::vector<Score>& scores) {
  std::string text;
  for (const Score& score : scores)
    for (std::size_t i = 0; i < judged_count; ++i)
      if (const Score::OfCue& cue = score.cues[i]; cue.worst > 0)
        text += fmt::format("{:<20}{:<12}{}\n", score.family, judged_name(i), cue.worst_fault);
  return text;
}

std::size_t Score::right_cues() const {
  std::size_t sum = 0;
  for (const OfCue& cue : cues) sum += cue.right;
  return sum;
}

std::string bars_of(const std::vector<Score>& scores) {
  // A cue that is rightly none in a program that could not have it would hide those that are wrong.
  static constexpr std::array sizes = {Cue::amplitude, Cue::stiffness, Cue::wall_stiffness,
                                       Cue::viscosity, Cue::friction,  Cue::mass};
  const auto period = [](const Score& score) {
    const Score::OfCue& cue = score.cues[static_cast<std::size_t>(Cue::period)];
    return Count(cue.right, cue.judged);
  };
  return bar("fundamental within 2 % or rightly none, of all programs", 0.98, scores, period) +
         bar("fundamental within 2 %, of programs that have one", 0.98, scores,
             [](const Score& score) { return of_sized(score, std::array{Cue::period}); }) +
         bar("amplitude, stiffness, viscosity, friction and mass within 3 % or the least, where there is one", 0.98,
             scores, [&](const Score& score) { return of_sized(score, sizes); }) +
         bar("programs of which nothing is read that they do not have", 0.99, scores,
             [](const Score& score) { return Count(score.programs - score.inventing, score.programs); }) +
         bar("programs that are right in every cue", 0.98, scores,
             [](const Score& score) { return Count(score.right, score.programs); });
}

}  // namespace wale::truth
