#include "compiler/check/check_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/check/experiment_stimuli.hpp"
#include "compiler/modules/declare_records.hpp"
#include "compiler/text/readable.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

template <std::size_t count>
std::vector<std::string> words_in(const char* const (&names)[count]) {
  return {std::begin(names), std::end(names)};
}

bool is_just_words(const SettingItem& item) { return !item.value && !item.equals && item.trailing.empty(); }

/// Reads the settings of one experiment.
class ExperimentChecker {
 public:
  ExperimentChecker(RecordReader& reader, const Surroundings& surroundings)
      : reader_(reader), surroundings_(surroundings) {}

  CheckedExperiment check() {
    ExperimentStimuli(reader_, surroundings_, made_).read();
    read_task();
    read_method();
    read_order();
    read_breaks();
    read_people();
    made_.questions = questions("question");
    made_.closing = questions("closing");
    check_task();
    return std::move(made_);
  }

 private:
  void wrong(Span span, std::string message, const char* example) {
    reader_.report(Code::wrong_type, span, std::move(message), fmt::format("write, for example, `{}`", example));
  }

  /// A whole number in a range. Empty after an error, which is reported.
  std::optional<int> whole(ExprId expr, Span span, int least, int most, const char* example) {
    const auto value = reader_.value(expr, Dimension{});
    if (!value) return std::nullopt;
    if (*value == std::floor(*value) && *value >= least && *value <= most) return static_cast<int>(*value);
    reader_.report(Code::value_out_of_range, span, fmt::format("expected a whole number from {} to {}", least, most),
                   fmt::format("write, for example, `{}`", example));
    return std::nullopt;
  }

  void read_count(const char* key, int least, int most, const char* example, int& into) {
    const Setting* setting = reader_.setting(key);
    if (!setting) return;
    const SettingItem& item = setting->items.front();
    if (!item.value || !item.words.empty() || setting->items.size() != 1)
      return wrong(setting->span, fmt::format("`{}` is a number", key), example);
    into = whole(*item.value, item.span, least, most, example).value_or(into);
  }

  /// A duration, s, that must be above 0 and at most a day. Empty after an error, which is reported.
  std::optional<double> duration(const SettingItem& item, const char* example) {
    constexpr double longest = 30.0 * 86400;
    if (!item.value || item.range_end || item.equals || !item.trailing.empty()) {
      wrong(item.span, "expected a duration", example);
      return std::nullopt;
    }
    const auto value = reader_.value(*item.value, surroundings_.declarations.dimension("time"));
    if (value && *value > 0 && *value <= longest) return value;
    if (value)
      reader_.report(Code::value_out_of_range, item.span, "a duration must be above 0, and at most 30 days",
                     fmt::format("write, for example, `{}`", example));
    return std::nullopt;
  }

  /// The index of the first word of an item among some names; otherwise that is reported.
  std::optional<std::size_t> named(const SettingItem& item, const std::vector<std::string>& names, const char* what) {
    if (item.words.empty()) {
      reader_.report(Code::wrong_type, item.span, fmt::format("expected the name of {}", what),
                     fmt::format("it is one of: {}", fmt::join(names, ", ")));
      return std::nullopt;
    }
    const Word& word = item.words.front();
    const auto found = std::ranges::find(names, word.text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    reader_.report(
        Code::unknown_name, word.span, fmt::format("no such name of {}: `{}`", what, word.text),
        did_you_mean(word.span, word.text, names, fmt::format("it is one of: {}", fmt::join(names, ", "))));
    return std::nullopt;
  }

  void read_task() {
    const Setting* setting = reader_.required("task", "magnitude_estimation");
    if (!setting) return;
    task_span_ = setting->span;
    const auto task = named(setting->items.front(), words_in(trial_task_names), "a task");
    if (!task) return;
    made_.task = static_cast<TrialTask>(*task);
    if (setting->items.front().words.size() > 1 || setting->items.front().value)
      return wrong(setting->items.front().span, "what a task needs stands behind a comma", "task sorting, groups 2, 3");
    bool in_groups = false;
    for (std::size_t i = 1; i < setting->items.size(); ++i) read_of_task(setting->items[i], in_groups);
  }

  void read_of_task(const SettingItem& item, bool& in_groups) {
    const auto* text = item.value ? std::get_if<TextLiteral>(&reader_.tree.expr(*item.value)) : nullptr;
    const std::string words = words_of(item);
    if (made_.task == TrialTask::magnitude_estimation && words == "modulus free" && !item.value) return;
    if (made_.task == TrialTask::magnitude_estimation && words == "modulus" && item.value) {
      const auto modulus = reader_.value(*item.value, Dimension{});
      if (modulus && !(*modulus > 0))
        return reader_.report(Code::value_out_of_range, item.span, "a modulus must be above 0",
                              "write, for example, `modulus 10`");
      if (modulus) made_.modulus = modulus;
      return;
    }
    const bool rates = made_.task == TrialTask::rating || made_.task == TrialTask::confidence;
    if (rates && text && item.words.empty() && made_.highest.empty()) {
      (made_.lowest.empty() ? made_.lowest : made_.highest) = text->text;
      return;
    }
    if (made_.task == TrialTask::sorting && words == "groups free" && !item.value) return;
    if (made_.task == TrialTask::sorting && item.value && !text && (words == "groups" || (in_groups && words.empty()))) {
      in_groups = true;
      if (const auto count = whole(*item.value, item.span, 2, 50, "task sorting, groups 2, 3, 4"))
        made_.groups.push_back(*count);
      return;
    }
    if (made_.task == TrialTask::adjustment && words.starts_with("over ") && is_just_words(item)) return over(item);
    reader_.report(Code::unknown_setting, item.span,
                   fmt::format("`{}` does not take this", trial_task_names[static_cast<std::size_t>(made_.task)]),
                   "magnitude_estimation takes `modulus free` or `modulus 10`; rating and confidence two texts; sorting "
                   "`groups 2, 3, 4` or `groups free`; adjustment `over FACTOR`");
  }

  /// Reads `over amplitude`.
  void over(const SettingItem& item) {
    names_over_ = true;
    const Word& word = item.words.back();
    std::vector<std::string> names;
    for (const ExperimentFactor& each : made_.factors) names.push_back(each.name);
    const auto found = std::ranges::find(names, word.text);
    if (found == names.end())
      return reader_.report(Code::unknown_name, word.span, fmt::format("there is no factor `{}`", word.text),
                            did_you_mean(word.span, word.text, names, "declare it: `factor amplitude 0.2 N, 0.8 N`"));
    const auto factor = static_cast<std::size_t>(found - names.begin());
    const auto& levels = made_.factors[factor].levels;
    const auto rises = [](const ExperimentLevel& a, const ExperimentLevel& b) {
      return a.value && b.value && *a.value < *b.value;
    };
    for (std::size_t i = 0; i + 1 < levels.size(); ++i)
      if (!rises(levels[i], levels[i + 1]))
        return reader_.report(Code::wrong_type, word.span,
                              fmt::format("the levels of `{}` must be quantities, from the lowest to the highest", *found),
                              "write, for example, `factor amplitude 0.2 N .. 2 N, steps 15`");
    if (levels.size() < 3)
      return reader_.report(Code::value_out_of_range, word.span, fmt::format("`{}` has too few levels to move along", *found),
                            "give it at least 3, as in `factor amplitude 0.2 N .. 2 N, steps 15`");
    made_.over = factor;
  }

  void read_method() {
    const Setting* setting = reader_.setting("method");
    if (!setting) return;
    const auto method = named(setting->items.front(), words_in(trial_method_names), "a method");
    if (!method) return;
    const bool forced = made_.task == TrialTask::two_interval || made_.task == TrialTask::one_interval ||
                        made_.task == TrialTask::same_different;
    if (!forced)
      return reader_.report(Code::unknown_setting, setting->span,
                            fmt::format("`{}` has no right and wrong answers that a method could go by",
                                        trial_task_names[static_cast<std::size_t>(made_.task)]),
                            "leave `method` out, or take two_interval, one_interval or same_different");
    made_.method = static_cast<TrialMethod>(*method);
    for (std::size_t i = 1; i < setting->items.size(); ++i) {
      const SettingItem& item = setting->items[i];
      const std::string words = words_of(item);
      const bool adapts = made_.method != TrialMethod::constant_stimuli;
      const bool steps = made_.method == TrialMethod::up_down;
      constexpr const char* example = "method up_down, over amplitude, up 1, down 3, reversals 8";
      const auto take = [&](int least, int most, int& into) {
        into = whole(*item.value, item.span, least, most, example).value_or(into);
      };
      if (adapts && is_just_words(item) && item.words.size() == 2 && words.starts_with("over ")) over(item);
      else if (steps && item.value && words == "up") take(1, 9, made_.up);
      else if (steps && item.value && words == "down") take(1, 9, made_.down);
      else if (steps && item.value && words == "reversals") take(2, 100, made_.reversals);
      else if (adapts && item.value && words == "trials") take(5, 1000, made_.trials);
      else
        reader_.report(Code::unknown_setting, item.span,
                       fmt::format("`{}` does not take this", trial_method_names[*method]),
                       "up_down takes `over FACTOR`, `up 1`, `down 3`, `reversals 8` and `trials 60`; quest_plus `over "
                       "FACTOR` and `trials 40`");
    }
    if (made_.method != TrialMethod::constant_stimuli && !made_.over && !names_over_)
      reader_.report(Code::missing_setting, setting->span, "an adaptive method moves along a factor",
                     "name it: `method up_down, over amplitude`");
  }

  void read_order() {
    if (const Setting* order = reader_.setting("order")) {
      const std::string words = order->items.size() == 1 ? words_of(order->items.front()) : "";
      if ((words != "random" && words != "fixed") || !is_just_words(order->items.front()))
        wrong(order->span, "the order is `random` or `fixed`", "order random");
      made_.random = words != "fixed";
    }
    read_count("repetitions", 1, 1000, "repetitions 3", made_.repetitions);
    if (const Setting* practice = reader_.setting("practice")) {
      const SettingItem& count = practice->items.front();
      if (!count.value || !count.words.empty()) return wrong(practice->span, "`practice` is a number of trials", "practice 6");
      made_.practice = whole(*count.value, count.span, 0, 1000, "practice 6").value_or(0);
      for (std::size_t i = 1; i < practice->items.size(); ++i) read_practised(practice->items[i]);
      if (made_.practised.size() > static_cast<std::size_t>(made_.practice))
        reader_.report(Code::value_out_of_range, practice->span, "more stimuli are named than practice has trials",
                       "name fewer of them, or give a larger number");
    }
    if (const Setting* catches = reader_.setting("catch")) {
      const auto share = reader_.quantity(*catches, 0, "number");
      if (share && !(*share > 0 && *share < 1))
        reader_.report(Code::value_out_of_range, catches->span, "the share of catch trials is between 0 and 1",
                       "write, for example, `catch 25 %`");
      made_.catches = share.value_or(made_.catches);
      if (made_.task != TrialTask::one_interval && made_.task != TrialTask::same_different)
        reader_.report(Code::unknown_setting, catches->span, "only one_interval and same_different have catch trials",
                       "leave `catch` out");
    }
  }

  void read_practised(const SettingItem& item) {
    const auto* text = item.value ? std::get_if<TextLiteral>(&reader_.tree.expr(*item.value)) : nullptr;
    const std::string name = text ? std::string(text->text) : is_just_words(item) ? words_of(item) : "";
    std::vector<std::string> names;
    for (const ExperimentStimulus& each : made_.stimuli) names.push_back(each.name);
    const auto found = std::ranges::find(names, name);
    if (found != names.end()) return made_.practised.push_back(static_cast<std::size_t>(found - names.begin()));
    if (names.empty()) return;  // they have errors, which are reported
    reader_.report(Code::unknown_name, item.span,
                   fmt::format("there is no stimulus `{}`", name.empty() ? surroundings_.sources.text(item.span) : name),
                   did_you_mean(item.span, name, names, "name one as `wale describe` lists it, in quotes if need be"));
  }

  void read_breaks() {
    if (const Setting* pause = reader_.setting("break")) {
      constexpr const char* example = "break 5 min, after 30 min";
      const SettingItem& first = pause->items.front();
      if (!first.words.empty() || pause->items.size() > 2) return wrong(pause->span, "a break is a duration", example);
      made_.pause = duration(first, example).value_or(0);
      if (pause->items.size() == 2) {
        const SettingItem& after = pause->items[1];
        if (words_of(after) == "after block" && is_just_words(after)) made_.pause_after = 0;
        else if (words_of(after) == "after") made_.pause_after = duration(after, example).value_or(0);
        else wrong(after.span, "a break comes `after` a duration, or `after block`", example);
      }
    }
    if (const Setting* present = reader_.setting("present")) {
      if (present->items.size() != 1 || !present->items.front().words.empty())
        return wrong(present->span, "`present` is a duration", "present 3 s");
      made_.seconds = duration(present->items.front(), "present 3 s").value_or(made_.seconds);
      constexpr double longest = 600;
      if (made_.seconds > longest)
        reader_.report(Code::value_out_of_range, present->span, "a presentation takes at most 10 minutes",
                       "write, for example, `present 3 s`");
      const double stroke = seconds_to_and_fro(surroundings_.declarations);
      if (made_.seconds < stroke)
        reader_.report(Code::beyond_soft_range, present->span,
                       readable("a presentation of {:.3g} s is shorter than one movement to and fro, {:.3g} s for the hand "
                                "`normal`",
                                made_.seconds, stroke),
                       readable("write `present {:.3g} s` or more: a hand passes over a part of the stimulus only, and "
                                "forces are read from what follows the first half second",
                                std::ceil(stroke)));
    }
    if (const Setting* exclude = reader_.setting("exclude")) {
      if (exclude->items.size() != 1 || words_of(exclude->items.front()) != "over")
        return wrong(exclude->span, "sessions are excluded `over` a duration", "exclude over 60 min");
      made_.longest = duration(exclude->items.front(), "exclude over 60 min");
    }
    if (const Setting* interrupted = reader_.setting("interrupted")) read_interrupted(*interrupted);
  }

  void read_interrupted(const Setting& setting) {
    constexpr const char* example = "interrupted resume 10 min, practice 60 min, restart 1440 min";
    InterruptedSession made;
    if (setting.items.size() == 1 && words_of(setting.items.front()) == "refuse" && is_just_words(setting.items.front())) {
      made_.interrupted = made;
      return;
    }
    for (const SettingItem& item : setting.items) {
      const std::string words = words_of(item);
      double* into = words == "resume"     ? &made.resume
                     : words == "practice" ? &made.repeat_practice
                     : words == "restart"  ? &made.restart_block
                                           : nullptr;
      if (!into) return wrong(item.span, "expected `resume`, `practice` or `restart` and how long ago, or `refuse`", example);
      *into = duration(item, example).value_or(0);
    }
    made.repeat_practice = std::max(made.repeat_practice, made.resume);
    made.restart_block = std::max(made.restart_block, made.repeat_practice);
    made_.interrupted = made;
  }

  void read_people() {
    if (const Setting* pages = reader_.setting("instructions")) made_.instructions = reader_.texts(*pages);
    made_.consent = reader_.text("consent");
    made_.ask = reader_.text("ask");
    made_.grip = reader_.text("grip");
    if (const Setting* masking = reader_.setting("masking"))
      for (const SettingItem& item : masking->items) {
        const auto* text = item.value ? std::get_if<TextLiteral>(&reader_.tree.expr(*item.value)) : nullptr;
        if (text) made_.masking = text->text;
        else if (words_of(item) == "required" && is_just_words(item)) made_.masking_required = true;
        else if (words_of(item) != "none" || !is_just_words(item))
          wrong(item.span, "masking is `required`, `none`, or a sound file", "masking required, \"pink_noise.wav\"");
      }
    if (const Setting* motion = reader_.setting("motion")) {
      const auto found = named(motion->items.front(), {"free", "lateral", "circular"}, "a motion");
      if (found) made_.motion = motion->items.front().words.front().text;
    }
  }

  std::vector<ExperimentQuestion> questions(const char* key) {
    std::vector<ExperimentQuestion> all;
    for (const Setting* setting : reader_.settings(key)) {
      const SettingItem& item = setting->items.front();
      const auto* text = item.value ? std::get_if<TextLiteral>(&reader_.tree.expr(*item.value)) : nullptr;
      if (!text || item.words.empty() || item.words.size() > 2 || setting->items.size() != 1) {
        wrong(setting->span, fmt::format("`{}` is a name, a kind of answer, and a text", key),
              "question sure rating \"How sure are you, from 0 to 100?\"");
        continue;
      }
      ExperimentQuestion made{std::string(item.words.front().text), AnswerKind::text, std::string(text->text)};
      const auto kinds = words_in(answer_kind_names);
      if (item.words.size() == 2) {
        const auto kind = std::ranges::find(kinds, item.words[1].text);
        if (kind == kinds.end()) {
          reader_.report(Code::unknown_name, item.words[1].span,
                         fmt::format("there is no kind of answer `{}`", item.words[1].text),
                         did_you_mean(item.words[1].span, item.words[1].text, kinds,
                                      fmt::format("it is one of: {}", fmt::join(kinds, ", "))));
          continue;
        }
        made.kind = static_cast<AnswerKind>(kind - kinds.begin());
      }
      const auto [first, is_new] = question_names_.emplace(made.name, item.words.front().span);
      if (!is_new)
        reader_.report(Code::declared_twice, item.words.front().span, fmt::format("there are two questions `{}`", made.name),
                       another_name(first->second));
      else if (std::ranges::find(own_answers, made.name) != std::end(own_answers))
        reader_.report(Code::declared_twice, item.words.front().span,
                       fmt::format("`{}` is the name of an answer or a column already", made.name),
                       "give the question another name");
      else all.push_back(std::move(made));
    }
    return all;
  }

  /// Checks what a task needs besides its own setting.
  void check_task() {
    if (!task_span_) return;
    const bool compares = made_.task == TrialTask::two_interval || made_.task == TrialTask::one_interval ||
                          made_.task == TrialTask::same_different || made_.task == TrialTask::adjustment;
    const std::string task = trial_task_names[static_cast<std::size_t>(made_.task)];
    const Setting* standard = reader_.setting("standard");
    if (compares && !standard)
      reader_.report(Code::missing_setting, *task_span_, fmt::format("`{}` compares with a standard", task),
                     "add one, as in `standard bench(amplitude: 0.8 N)`");
    if (!compares && standard)
      reader_.report(Code::unknown_setting, standard->span, fmt::format("`{}` compares with no standard", task),
                     "leave `standard` out, or make it a `stimulus`");
    if (made_.task == TrialTask::adjustment && !made_.over && !names_over_)
      reader_.report(Code::missing_setting, *task_span_, "an adjustment moves along a factor",
                     "name it: `task adjustment, over amplitude`");
    if (made_.task == TrialTask::sorting) {
      for (const int count : made_.groups)
        if (static_cast<std::size_t>(count) > made_.stimuli.size() && !made_.stimuli.empty())
          reader_.report(Code::value_out_of_range, *task_span_,
                         fmt::format("{} stimuli cannot be sorted into {} groups", made_.stimuli.size(), count),
                         "add stimuli, or take fewer groups");
      if (made_.stimuli.size() == 1)
        reader_.report(Code::value_out_of_range, *task_span_, "one stimulus cannot be sorted", "add stimuli");
    }
    if (made_.over)
      for (const ExperimentStimulus& each : made_.stimuli)
        if (!each.levels[*made_.over]) {
          reader_.report(Code::unknown_name, each.span,
                         fmt::format("`{}` does not depend on `{}`, along which the method moves", each.name,
                                     made_.factors[*made_.over].name),
                         "name the factor in each stimulus");
          break;
        }
    constexpr std::size_t most_trials = 20000;
    if (made_.stimuli.size() * static_cast<std::size_t>(made_.repetitions) > most_trials)
      reader_.report(Code::value_out_of_range, *task_span_,
                     fmt::format("more than {} trials are more than a session holds", most_trials),
                     "present fewer stimuli, or each less often");
  }

  /// Names that a log or a table has for something else.
  static constexpr const char* own_answers[] = {"pile",  "label",    "response", "trial", "block",  "stimulus", "onset",
                                                "match", "interval", "correct",  "n",     "consent"};

  RecordReader& reader_;
  const Surroundings& surroundings_;
  CheckedExperiment made_;
  std::optional<Span> task_span_;
  std::map<std::string, Span> question_names_;
  bool names_over_ = false;  ///< a factor to move along is named, rightly or not
};

}  // namespace

double seconds_to_and_fro(const Declarations& declarations) {
  const HandDeclaration* hand = declarations.hands.find("normal");
  return hand != nullptr && hand->lateral_frequency > 0 ? 1 / hand->lateral_frequency : 0;
}

void check_experiments(const SyntaxTree& tree, const Surroundings& surroundings, CheckedModule& module) {
  std::map<std::string_view, Span> declared;
  for (const Declaration& declaration : tree.declarations) {
    const auto* record = std::get_if<RecordDecl>(&declaration);
    if (!record || record->keyword.text != "experiment") continue;
    RecordReader reader(tree, *record, surroundings.sources, surroundings.declarations, surroundings.diagnostics);
    const std::size_t errors_before = surroundings.diagnostics.error_count();
    const auto [first, is_new] = declared.emplace(record->name.text, record->name.span);
    if (!is_new) {
      reader.report(Code::declared_twice, record->name.span,
                    fmt::format("there are two experiments `{}`", record->name.text), another_name(first->second));
      continue;
    }
    CheckedExperiment checked = ExperimentChecker(reader, surroundings).check();
    reader.report_keys();
    if (surroundings.diagnostics.error_count() > errors_before) continue;
    checked.name = record->name.text;
    checked.documentation = record->documentation;
    checked.span = record->name.span;
    checked.statement = record->span;
    module.experiments.push_back(std::move(checked));
  }
}

}  // namespace wale
