#include "calibration/feel/hand_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/quantity.hpp"
#include "compiler/typed_number.hpp"
#include "runtime/device/simulated/load_trace.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

constexpr const char* hand_option = "--hand";
const std::vector<std::string> motions{"lateral", "circular", "press", "rest"};

Error wrong_motion(const std::string& text, std::string sentence, std::string mend) {
  return {.code = Code::malformed_value,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = hand_option, .text = text}};
}

/// Removes the blanks around a text.
std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') + 1 - first));
}

/// A motion's words, cut before `along` and `at`.
struct TypedMotion {
  std::string kind;
  std::optional<std::string> along, at;
};

Result<TypedMotion> split(const std::string& hand) {
  TypedMotion typed;
  std::string* part = &typed.kind;
  for (std::size_t begin = 0; begin < hand.size();) {
    const std::size_t end = std::min(hand.find(' ', begin), hand.size());
    const std::string word = hand.substr(begin, end - begin);
    begin = end + 1;
    if (word == "along" || word == "at") {
      std::optional<std::string>& next = word == "at" ? typed.at : typed.along;
      if (next) return wrong_motion(hand, fmt::format("expected one `{}`, found two", word), "say it once");
      part = &next.emplace();
    } else if (!word.empty()) {
      *part += (part->empty() ? "" : " ") + word;
    }
  }
  return typed;
}

/// The direction that `text` names, a vector of length 1.
Result<glm::dvec2> direction_of(const std::string& text) {
  if (text == "x") return glm::dvec2(1, 0);
  if (text == "y") return glm::dvec2(0, 1);
  constexpr double degrees_of_a_turn = 360;
  const std::size_t unit = text.rfind("deg");
  if (unit != std::string::npos && unit + 3 == text.size())
    if (const auto degrees = read_number(hand_option, trimmed(text.substr(0, unit)),
                                         {.least = -degrees_of_a_turn, .most = degrees_of_a_turn}))
      return heading(*degrees / degrees_of_a_turn);
  return wrong_motion(text, fmt::format("expected `x`, `y` or an angle after `along`, {}", found_typed(text)),
                      "for example, `--hand \"lateral along 30 deg\"`; from x to the left, at most 360 deg");
}

Error no_such_motion(const std::string& hand) {
  auto near = nearest_spelling(hand, motions);
  constexpr std::size_t telling = 4;  // letters; "circle" is meant as "circular", but differs by too many letters
  for (const std::string& motion : motions)
    if (!near && hand.size() >= telling && motion.starts_with(hand.substr(0, telling))) near = motion;
  return wrong_motion(hand, fmt::format("`{}` is neither lateral, circular, press, rest nor the file of a trace", hand),
                      near ? fmt::format("did you mean `{}`?", *near) : "a trace is a CSV file of t, x, y");
}

Result<Motion> of_trace(const std::string& hand) {
  auto trace = load_trace(hand);
  if (trace) return Motion(*std::move(trace));
  std::error_code ignored;
  const bool is_path = hand.find('/') != std::string::npos || has_ending(hand, ".csv");
  if (is_path || std::filesystem::exists(hand, ignored)) return std::move(trace.error());
  return no_such_motion(hand);
}

}  // namespace

Result<Motion> motion_of(const std::string& hand, const HandDeclaration& person, const Declarations& units) {
  const auto typed = split(hand);
  const bool known = typed && std::ranges::find(motions, typed->kind) != motions.end();
  if (!known) {
    // A file may have any name, also one with these words.
    std::error_code ignored;
    const bool plain = typed && !typed->along && !typed->at;
    if (plain || std::filesystem::exists(hand, ignored)) return of_trace(hand);
    return typed ? no_such_motion(typed->kind) : typed.error();
  }
  glm::dvec2 direction(1, 0), middle(0);
  if (typed->along) {
    const auto asked = direction_of(*typed->along);
    if (!asked) return asked.error();
    if (typed->kind == "circular" || typed->kind == "rest")
      return wrong_motion(hand, fmt::format("expected no `along`: {} has no direction", typed->kind),
                          "leave it out, or choose lateral or press");
    direction = *asked;
  }
  if (typed->at) {
    const auto place = read_hand(units, hand_option, *typed->at);
    if (!place)
      return wrong_motion(*typed->at, place.error().sentence, "for example, `--hand \"lateral at 20 mm, 5 mm\"`");
    middle = glm::dvec2(place->position);
  }
  if (typed->kind == "circular") return Motion(Circular{person.circular_radius, person.circular_frequency, middle});
  if (typed->kind == "rest") return Motion(Rest{middle});
  if (typed->kind == "press") return Motion(Press{person.press_depth, person.press_frequency, middle, direction});
  return Motion(Lateral{person.lateral_amplitude, person.lateral_frequency, middle, direction});
}

}  // namespace wale
