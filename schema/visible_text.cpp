#include "schema/visible_text.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "schema/utf8.hpp"

namespace wale {
namespace {

/// Most texts are all of these characters, and stay as they are.
bool is_plain(char c) { return c >= ' ' && c <= '~'; }

std::string visible(std::string_view text, bool in_lines) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text.substr(at), is_plain) - text.begin());
    shown += text.substr(at, end - at);
    if ((at = end) == text.size()) break;
    const Character character = decode(text, at);
    if (in_lines && text.substr(at).starts_with("\r\n")) {
      // a line break as well; the next character is it
    } else if (in_lines && text[at] == '\t') {
      shown += ' ';
    } else if (!character.valid) {
      shown += "\uFFFD";
    } else if (is_obeyed_by_terminals(character.code) && !(in_lines && text[at] == '\n')) {
      char digits[16];
      std::snprintf(digits, sizeof digits, "\\u%04x", static_cast<unsigned>(character.code));
      shown += digits;
    } else {
      shown += text.substr(at, character.bytes);
    }
    at += character.bytes;
  }
  return shown;
}

void make_visible(std::string& text) {
  if (!std::ranges::all_of(text, is_plain)) text = visible(text, false);
}

}  // namespace

bool is_obeyed_by_terminals(char32_t code) {
  const bool controls = code < ' ' || (code >= 0x7F && code < 0xA0);
  const bool breaks = code == 0x2028 || code == 0x2029;
  const bool turns = code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x202A && code <= 0x202E) ||
                     (code >= 0x2066 && code <= 0x2069);
  return controls || breaks || turns;
}

std::string visible_text(std::string_view text) { return visible(text, false); }
std::string visible_lines(std::string_view text) { return visible(text, true); }

void make_visible(PatchProgram& program) {
  make_visible(program.material);
  make_visible(program.device.name);
  for (Parameter& each : program.parameters)
    for (std::string* text : {&each.name, &each.unit, &each.si_unit, &each.description}) make_visible(*text);
  for (State& each : program.states)
    for (std::string* text : {&each.name, &each.si_unit}) make_visible(*text);
  for (Grid& each : program.grids)
    for (std::string* text : {&each.name, &each.si_unit}) make_visible(*text);
  for (PerceptRecord& each : program.percepts)
    for (std::string* text : {&each.name, &each.carrier, &each.map, &each.device, &each.source, &each.unit,
                              &each.weber_source, &each.realisation})
      make_visible(*text);
  for (PerceptRecord& each : program.percepts)
    for (MeasuredRange& range : each.basis.ranges)
      for (std::string* text : {&range.quantity, &range.unit}) make_visible(*text);
  for (FateRecord& each : program.fates)
    for (std::string* text : {&each.name, &each.reason}) make_visible(*text);
  for (LevelClaim& each : program.claims) make_visible(each.percept);
  for (auto& [key, values] : program.layers.representative) {
    make_visible(key);
    for (std::string& value : values) make_visible(value);
  }
  for (std::string* text : {&program.layers.perceptual, &program.layers.physical, &program.layers.documentation})
    *text = visible(*text, true);
  for (std::string& file : program.places.files) make_visible(file);
}

}  // namespace wale
