#include "compiler/listing/figures.hpp"

#include <fmt/format.h>

namespace wale {

std::string figure(float value) { return fmt::format("{}", value); }
std::string figure(double value) { return fmt::format("{}", value); }

std::string input_name(unsigned number) {
  switch (static_cast<Input>(number)) {
    case Input::x: return "x";
    case Input::y: return "y";
    case Input::velocity_x: return "velocity_x";
    case Input::velocity_y: return "velocity_y";
    case Input::patch_half_width: return "patch_half_width";
    case Input::patch_half_height: return "patch_half_height";
    case Input::patch_rim: return "patch_rim";
    case Input::probe: return "probe";
    case Input::acceleration_x: return "acceleration_x";
    case Input::acceleration_y: return "acceleration_y";
    case Input::raw_velocity_x: return "raw_velocity_x";
    case Input::raw_velocity_y: return "raw_velocity_y";
    case Input::raw_acceleration_x: return "raw_acceleration_x";
    case Input::raw_acceleration_y: return "raw_acceleration_y";
    case Input::workspace_x: return "workspace_x";
    case Input::workspace_y: return "workspace_y";
    case Input::time: return "time";
    case Input::button: return "button";
    case Input::seconds_per_tick: return "seconds_per_tick";
    case Input::shape_edge: return "shape_edge";
    case Input::shape_edge_x: return "shape_edge_x";
    case Input::shape_edge_y: return "shape_edge_y";
  }
  return fmt::format("input {}", number);
}

std::string section_name(CodeSection section, std::size_t index) {
  switch (section) {
    case CodeSection::setup: return "setup";
    case CodeSection::peak: return fmt::format("peak {}", index);
    case CodeSection::enter: return "enter";
    case CodeSection::tick: return "tick";
    case CodeSection::picture: return "picture";
    case CodeSection::frame: return "frame";
    case CodeSection::prediction: return fmt::format("prediction {}", index);
  }
  return {};
}

std::string shown(const std::optional<SourceLine>& line) {
  return line ? fmt::format("{}:{}", line->file, line->line) : "";
}

std::string beside(std::string text, std::size_t column, const std::string& more) {
  if (more.empty()) return text;
  text.resize(std::max(column, text.size() + 2), ' ');
  return text + more;
}

std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

}  // namespace wale
