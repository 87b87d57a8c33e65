#include "compiler/check/check_usage.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

constexpr double turn = 2 * std::numbers::pi;  // rad

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-9 * std::max(1.0, std::abs(value)); }

/// Whether it is a half or a whole turn in degrees, the numbers of which conversions are made.
bool is_turn_in_degrees(double value) { return std::abs(value) == 180 || std::abs(value) == 360; }

/// Whether it is 180 / pi, by which radians become degrees.
bool makes_degrees(double value) { return std::abs(std::abs(value) * std::numbers::pi / 180 - 1) < 1e-3; }

/// Whether it is a multiple of pi / 6, as people write it, `6.28` included.
bool is_turn_in_radians(double value) {
  constexpr double parts_of_pi = 6, largest = 8 * std::numbers::pi, written = 1e-3;
  const double parts = std::abs(value) / std::numbers::pi * parts_of_pi;
  return std::abs(value) <= largest && parts > 0.5 && std::abs(parts - std::round(parts)) < written * parts;
}

/// Whether it is one number in Hz or in a multiple of it: "30 Hz". Of `2 pi * 30 Hz`, which is one number too once it
/// is computed, nobody knows what it counts; and of 377 Hz, the whole turns of which are already in radians.
bool counts_turns(std::string_view text, double value) {
  if (!text.ends_with("Hz")) return false;
  text.remove_suffix(2);
  const std::size_t unit = text.find_first_not_of("0123456789.eE+-_");
  if (unit == 0 || (unit != text.npos && text.substr(unit).find_first_of("0123456789*/()") != text.npos)) return false;
  const double turns = value / turn;
  return turns < 1 || std::abs(turns - std::round(turns)) > 1e-4 * turns;
}

class AngleReader {
 public:
  AngleReader(const CheckedMaterial& material, const CallRecord& record, const Surroundings& surroundings)
      : material_(material), terms_(material.terms), record_(record), surroundings_(surroundings) {
    for (const auto& [frequency, state] : record.phases) phases_.insert(state);
  }

  void read(const CheckedAngle& angle) {
    if (!seen_.insert(angle.angle).second) return;
    place_ = angle.span;
    if (const auto value = far_and_whole(angle.angle)) return degrees(angle.angle, *value);
    constexpr int most_summands = 64;
    summands_left_ = most_summands;
    turns_ = false;
    read_sum(angle.angle);
    if (turns_) turning_.push_back(angle);
  }

  /// The angles that a multiple of pi is a factor of, and which are therefore meant to turn.
  const std::vector<CheckedAngle>& turning() const { return turning_; }

 private:
  /// What one summand of an angle is made of.
  struct Factors {
    std::optional<TermId> degrees;  ///< a literal 180 or 360 that multiplies
    bool radians = false;           ///< a multiple of pi multiplies
    bool phase = false, time = false, hertz = false;
    int others = 0;
    int left = 32;  ///< factors that may still be read
  };

  /// The value of an angle that is the same everywhere, more than a turn, and a multiple of 5, as degrees mostly are
  /// and radians hardly ever.
  std::optional<double> far_and_whole(TermId angle) const {
    const auto meant_in_degrees = [](double value) { return std::abs(value) > turn && is_whole(value / 5); };
    if (const Term& term = terms_[angle]; term.kind == TermKind::parameter) {
      if (term.index >= material_.parameters.size()) return std::nullopt;
      const Parameter& parameter = material_.parameters[term.index];
      if (!parameter.unit.empty()) return std::nullopt;
      for (const double value : {parameter.value, parameter.high, parameter.low})
        if (meant_in_degrees(value)) return value;
      return std::nullopt;
    }
    const auto value = constant_value(terms_, angle, &material_.parameters);
    return value && meant_in_degrees(*value) ? value : std::nullopt;
  }

  void degrees(TermId angle, double value) {
    const Term& term = terms_[angle];
    if (term.kind == TermKind::parameter)
      return report(place_,
                    readable("angles are in radians, and `{}` reaches {:.6g}, which is {:.3g} turns",
                             material_.parameters[term.index].name, value, std::abs(value) / turn),
                    "give it and its range in degrees, as in `45 deg in 0 deg .. 90 deg`", {});
    const Span span = own_place(angle);
    const std::string text(surroundings_.sources.text(span));
    const bool is_bare = text == fmt::format("{}", std::abs(value)) || text == fmt::format("{}", value);
    report(span, readable("angles are in radians: {:.6g} of them are {:.3g} turns", value, std::abs(value) / turn),
           typeable("for degrees write `{:.6g} deg`", value),
           is_bare ? std::vector{insert_after(span, " deg", fmt::format("write `{} deg`", text), false)}
                   : std::vector<Fix>{});
  }

  void read_sum(TermId id) {
    if (--summands_left_ < 0) return;
    const Term& term = terms_[id];
    if (!term.known() && term.kind == TermKind::operation) {
      if (term.operation == Operation::add || term.operation == Operation::subtract) {
        read_sum(term.a);
        return read_sum(term.b);
      }
      if (term.operation == Operation::negate) return read_sum(term.a);
    }
    Factors factors;
    read_product(id, false, factors);
    turns_ = turns_ || factors.radians;
    if (factors.radians) return;
    if (factors.degrees) return in_degrees(*factors.degrees);
    if (factors.phase && factors.others == 0)
      return report(place_, "angles are in radians, and a phase runs from 0 to 1 for each turn",
                    "write `2 pi * phase(…)`", {});
    if (factors.time && factors.hertz)
      report(place_, "angles are in radians, and a frequency in Hz times the time counts turns",
             "write `2 pi *` before the frequency", {});
  }

  void in_degrees(TermId literal) {
    const double value = terms_[literal].value;
    if (makes_degrees(value))
      return report(own_place(literal), "angles are in radians, and this one is turned into degrees before",
                    readable("leave out the factor of {:.3g}, or use it for what is printed only", value), {});
    const char* meant = std::abs(value) == 180 ? "pi" : "2 pi";
    const Span span = own_place(literal);
    const bool is_bare = surroundings_.sources.text(span) == fmt::format("{}", std::abs(value));
    report(span,
           readable("angles are in radians, and {:.6g} seems to be {} in degrees", value,
                    std::abs(value) == 180 ? "half a turn" : "a turn"),
           typeable("write `{}` instead of `{:.6g}`", meant, std::abs(value)),
           is_bare ? std::vector{replace(span, meant, {}, false)} : std::vector<Fix>{});
  }

  void read_product(TermId id, bool divides, Factors& factors) const {
    if (--factors.left < 0) {
      ++factors.others;
      return;
    }
    const Term& term = terms_[id];
    const bool is_operation = term.kind == TermKind::operation;
    if (term.known()) {
      factors.hertz = factors.hertz || counts_turns(surroundings_.sources.text(term.span), term.value);
      if (!divides && (is_turn_in_degrees(term.value) || makes_degrees(term.value))) factors.degrees = id;
      if (!divides && is_turn_in_radians(term.value)) factors.radians = true;
      if (!is_turn_in_degrees(term.value) && std::abs(term.value) != 1) ++factors.others;
    } else if (is_operation && (term.operation == Operation::multiply || term.operation == Operation::divide)) {
      read_product(term.a, divides, factors);
      read_product(term.b, divides != (term.operation == Operation::divide), factors);
    } else if (is_operation && term.operation == Operation::negate) {
      read_product(term.a, divides, factors);
    } else if (phases_.contains(id) && !divides) {
      factors.phase = true;
    } else if (term.kind == TermKind::input && term.input() == Input::time && !divides) {
      factors.time = true;
    } else if (term.kind == TermKind::parameter && !divides && term.index < material_.parameters.size() &&
               material_.parameters[term.index].unit.ends_with("Hz")) {
      factors.hertz = true;
    } else {
      ++factors.others;
    }
  }

  /// The place of a literal in the author's text, or else of the call that led to it.
  Span own_place(TermId id) const {
    const Span span = terms_[id].span;
    return span.source == place_.source && span.begin < span.end ? span : place_;
  }

  void report(Span span, std::string message, std::string help, std::vector<Fix> fixes) {
    if (!reported_.emplace(span.source, span.begin).second) return;
    surroundings_.diagnostics.report(
        Advice(std::move(help)).fix(std::move(fixes)).about(Code::not_radians, span, std::move(message)));
  }

  const CheckedMaterial& material_;
  const Terms& terms_;
  const CallRecord& record_;
  const Surroundings& surroundings_;
  std::set<TermId> phases_, seen_;
  std::set<std::pair<SourceId, std::uint32_t>> reported_;
  Span place_;
  int summands_left_ = 0;
  bool turns_ = false;  // of the angle that is read
  std::vector<CheckedAngle> turning_;
};

/// Warns of a value outside the range that a function states for it. Whether it warned.
bool check_usual(const CheckedUsual& usual, const CheckedMaterial& material, const Surroundings& surroundings) {
  const auto value = constant_value(material.terms, usual.value, &material.parameters);
  if (!value || (*value >= usual.low && *value <= usual.high)) return false;
  const std::string unit = surroundings.declarations.names().unit(usual.dimension);
  const std::string suffix = unit.empty() ? "" : " " + unit;
  const Span literal = material.terms[usual.value].span;
  const bool has_percent = surroundings.sources.text(literal).find('%') != std::string_view::npos;
  const bool in_percent = unit.empty() && usual.high == 1 && *value > 1 && *value <= 100 && !has_percent;
  const std::string bare = typeable("{:.6g}", *value);
  const bool is_bare = surroundings.sources.text(literal) == bare;
  const Span span = is_bare ? literal : usual.span;
  if (std::isinf(usual.high)) {
    surroundings.diagnostics.report(
        Advice(usual.low == 0 ? std::string("leave out the minus; for a force the other way put it before the function")
                              : readable("give a value of {:.6g}{} or more", usual.low, suffix))
            .fact("low", usual.low, unit)
            .about(Code::beyond_soft_range, span,
                   readable("`{}` is {}{}, and it is usually {:.6g}{} or more", usual.name, bare, suffix, usual.low,
                            suffix)));
    return true;
  }
  surroundings.diagnostics.report(
      Advice(in_percent ? fmt::format("percentages have their sign: write `{} %`", bare)
                        : readable("give a value from {:.6g}{} to {:.6g}{}", usual.low, suffix, usual.high, suffix))
          .fix(in_percent && is_bare ? std::vector{insert_after(span, " %", fmt::format("write `{} %`", bare), false)}
                                     : std::vector<Fix>{})
          .fact("low", usual.low, unit)
          .fact("high", usual.high, unit)
          .about(Code::beyond_soft_range, span,
                 readable("`{}` is {}{}, outside its usual range, {:.6g} .. {:.6g}{}", usual.name, bare, suffix,
                          usual.low, usual.high, suffix)));
  return true;
}

}  // namespace

std::vector<CheckedAngle> check_usage(const CheckedMaterial& material, const CallRecord& record,
                                      const Surroundings& surroundings) {
  AngleReader angles(material, record, surroundings);
  for (const CheckedAngle& each : record.angles) angles.read(each);
  std::set<std::pair<SourceId, std::uint32_t>> said;
  for (const CheckedUsual& each : record.usual)
    if (!said.contains({each.span.source, each.span.begin}) && check_usual(each, material, surroundings))
      said.emplace(each.span.source, each.span.begin);
  return angles.turning();
}

}  // namespace wale
