// The marks of a patch's sliders.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/check/ask.hpp"
#include "compiler/check/check_workspace.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

constexpr const char* example_of_mark = "write, for example, `mark roughness, low 0.2, high 0.45, \"still denim\"`";

class MarkChecker {
 public:
  MarkChecker(const CheckedPatch& patch, const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings)
      : patch_(patch),
        tree_(*declared.tree),
        home_(*declared.home),
        surroundings_(surroundings),
        checker_(surroundings, terms_, tables_) {}

  std::optional<SliderMark> check(const Setting& setting) {
    const SettingItem& first = setting.items.front();
    if (first.words.size() != 1 || first.value || first.equals)
      return refuse(Code::wrong_type, first.span, "a mark begins with the slider that it is on", example_of_mark);
    SliderMark mark{.slider = std::string(first.words.front().text), .span = setting.span};
    if (!find(first.words.front(), mark)) return std::nullopt;
    for (std::size_t i = 1; i < setting.items.size(); ++i)
      if (!read(setting.items[i], mark)) return std::nullopt;
    if (!mark.low && !mark.high)
      return refuse(Code::missing_setting, setting.span, "a mark needs an end: `low`, `high` or both", example_of_mark);
    if (mark.low && mark.high && *mark.low > *mark.high)
      return refuse(Code::value_out_of_range, setting.span, "the low end of this mark is above its high end",
                    reversed_ ? fmt::format("`{}` is the other end of the scale of `{}`: exchange `low` and `high`",
                                            first.words.front().text, mark.slider)
                              : std::string("exchange `low` and `high`"));
    return mark;
  }

 private:
  /// Finds the slider: a parameter of the material, or a percept that it asks for.
  bool find(const Word& word, SliderMark& mark) {
    const CheckedMaterial& material = *patch_.material;
    const auto parameter = std::ranges::find(material.parameters, word.text, &Parameter::name);
    if (parameter != material.parameters.end()) {
      parameter_ = &*parameter;
      mark.unit = parameter->unit;
      return true;
    }
    const PerceptName meant = home_.percept_named(word.text);
    if (meant.percept &&
        std::ranges::find(material.percepts, meant.percept->name, &AskedPercept::name) != material.percepts.end()) {
      mark.slider = meant.percept->name;
      mark.is_percept = true;
      reversed_ = meant.reversed;
      return true;
    }
    std::vector<std::string> known;
    for (const AskedPercept& each : material.percepts) known.push_back(each.name);
    for (const Parameter& each : material.parameters) known.push_back(each.name);
    refuse(Code::unknown_name, word.span, fmt::format("`{}` has no slider `{}`", patch_.made_of, word.text),
           did_you_mean(word.span, word.text, known,
                        known.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(known, ", "))));
    return false;
  }

  bool read(const SettingItem& item, SliderMark& mark) {
    if (item.range_end || item.equals || !item.trailing.empty()) return misread(item);
    if (item.words.empty()) {
      const auto* text = item.value ? std::get_if<TextLiteral>(&tree_.expr(*item.value)) : nullptr;
      if (!text) return misread(item);
      if (!mark.says.empty()) {
        refuse(Code::declared_twice, item.span, "a mark has one text", "put everything into one");
        return false;
      }
      mark.says = text->text;
      return true;
    }
    const std::string_view end = item.words.front().text;
    const bool is_low = end == "low";
    if (!is_low && end != "high") {
      refuse(Code::unknown_setting, item.words.front().span, fmt::format("a mark has no `{}`", end),
             did_you_mean(item.words.front().span, end, {"low", "high"}, "it has: low, high, and a text in quotes"));
      return false;
    }
    const bool is_named = item.words.size() == 2 && !item.value;  // `low fine`
    if (!is_named && (item.words.size() != 1 || !item.value)) return misread(item);
    std::optional<double>& place = is_low ? mark.low : mark.high;
    if (place) {
      refuse(Code::declared_twice, item.span, fmt::format("`{}` is given twice", end), "give it once");
      return false;
    }
    place = mark.is_percept ? level(item, mark, is_named) : parameter(item);
    return place.has_value();
  }

  bool misread(const SettingItem& item) {
    refuse(Code::wrong_type, item.span, "expected `low`, `high` or a text in quotes", example_of_mark);
    return false;
  }

  std::optional<double> level(const SettingItem& item, const SliderMark& mark, bool is_named) {
    if (is_named) return named_level(home_, mark.slider, item.words.back(), surroundings_.diagnostics);
    Scope scope;
    const auto value = checker_.constant(tree_, *item.value, scope, Dimension{});
    if (!value) return std::nullopt;
    if (!(*value >= 0 && *value <= 1)) {
      refuse(Code::level_out_of_range, item.span, readable("the level {:.4g} is outside 0 .. 1", *value),
             "give a number from 0 to 1");
      return std::nullopt;
    }
    return reversed_ ? 1 - *value : *value;
  }

  std::optional<double> parameter(const SettingItem& item) {
    const Parameter& slider = *parameter_;
    if (!item.value) {
      misread(item);
      return std::nullopt;
    }
    Scope scope;
    const Value checked = checker_.check(tree_, *item.value, scope);
    if (checked.failed()) return std::nullopt;
    const std::string unit = home_.names().unit(checked.dimension);
    if (checked.type != Value::Type::number || unit != slider.si_unit) {
      const std::string expected = slider.unit.empty() ? "a plain number" : fmt::format("a value in {}", slider.unit);
      refuse(Code::wrong_dimension, item.span,
             fmt::format("expected {} for `{}`, found {}", expected, slider.name,
                         checked.type != Value::Type::number ? "no number"
                         : unit.empty()                      ? "a plain number"
                                                             : fmt::format("a value in {}", unit)),
             slider.unit.empty() ? std::string("leave out the unit")
                                 : fmt::format("write `{} … {}`", item.words.front().text, slider.unit));
      return std::nullopt;
    }
    const auto value = checker_.constant(checked);
    if (!value) return std::nullopt;
    const auto held = static_cast<float>(*value);  // as the range is, so that its own ends are in it
    if (held < slider.low || held > slider.high) {
      refuse(Code::value_out_of_range, item.span,
             readable("`{}` is from {:.4g} to {:.4g}{}", slider.name, slider.low / slider.unit_in_si,
                      slider.high / slider.unit_in_si, slider.unit.empty() ? "" : " " + slider.unit),
             "give a value in this range");
      return std::nullopt;
    }
    return value;
  }

  std::nullopt_t refuse(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
    return std::nullopt;
  }

  const CheckedPatch& patch_;
  const SyntaxTree& tree_;
  const Declarations& home_;
  const Surroundings& surroundings_;
  Terms terms_;
  std::vector<HeightTable> tables_;
  ExpressionChecker checker_;
  const Parameter* parameter_ = nullptr;
  bool reversed_ = false;
};

}  // namespace

std::optional<SliderMark> check_mark(const Setting& setting, const CheckedPatch& patch,
                                     const Declared<WorkspaceDecl>& declared, const Surroundings& surroundings) {
  return MarkChecker(patch, declared, surroundings).check(setting);
}

}  // namespace wale
