#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/describe/describe_motion.hpp"
#include "compiler/describe/fates_json.hpp"
#include "compiler/text/json_text.hpp"

namespace wale {
namespace {

nlohmann::ordered_json to_json(const Parameter& parameter) {
  nlohmann::ordered_json json = {{"name", parameter.name},
                                 {"unit", parameter.unit},
                                 {"value", shown(parameter.value, parameter.unit_in_si)},
                                 {"min", shown(parameter.low, parameter.unit_in_si)},
                                 {"max", shown(parameter.high, parameter.unit_in_si)}};
  if (parameter.soft_low != parameter.low || parameter.soft_high != parameter.high) {
    json["soft_min"] = shown(parameter.soft_low, parameter.unit_in_si);
    json["soft_max"] = shown(parameter.soft_high, parameter.unit_in_si);
  }
  json["description"] = parameter.description;
  return json;
}

nlohmann::ordered_json to_json(const WorstPlace& place) {
  return {{"x_m", figure(place.position.x)},
          {"y_m", figure(place.position.y)},
          {"velocity_x", figure(place.velocity.x)},
          {"velocity_y", figure(place.velocity.y)}};
}

nlohmann::ordered_json to_json(const Grade& grade) {
  nlohmann::ordered_json json = {{"name", standing_word(grade.standing)}};
  if (grade.standing == Standing::not_analysed) return json;
  if (const auto assumed = grade.assumed_standing()) json["assumed"] = standing_word(*assumed);
  json["required_damping"] = figure(grade.required_damping);
  json["at"] = to_json(grade.worst);
  json["device_damping"] = figure(grade.device_damping);
  json["damping_known"] = grade.damping_known;
  json["hand_damping"] = figure(grade.hand_damping);
  if (const auto margin = grade.margin()) json["margin"] = figure(*margin);
  json["step_newton"] = figure(grade.step_newton);
  json["jumps"] = grade.jumps;
  if (grade.buzzes) json["buzzes"] = *grade.buzzes;
  json["finest_period_m"] = figure(grade.finest_period);
  json["counts_per_period"] = figure(grade.counts_per_period);
  json["fastest_hand"] = figure(grade.fastest_hand);
  json["force_levels"] = figure(grade.force_levels);
  json["conservative"] = grade.energy.conservative;
  json["watt"] = figure(grade.energy.watt());
  json["reasons"] = grade.energy.reasons;
  if (grade.later_newton > 0)
    json["looked_at_seconds"] = still_seconds, json["later_newton"] = figure(grade.later_newton);
  return json;
}

nlohmann::ordered_json to_json(const DescribedTexture& texture) {
  nlohmann::ordered_json json = {{"kind", texture.kind}};
  json["class"] = texture.texture_class;
  json["size_class"] = texture.size_class;
  json["confidence"] = texture.confidence;
  if (texture.confidence_mean) json["confidence_mean"] = figure(*texture.confidence_mean);
  if (texture.confidence_spread) json["confidence_spread"] = figure(*texture.confidence_spread);
  if (!texture.source.empty()) json["source"] = texture.source;
  const Relief& force = texture.force;
  json["amplitude_newton"] = figure(force.amplitude);
  if (!(force.amplitude > 0)) return json;
  json["maximum_newton"] = figure(force.maximum);
  json["rms_newton"] = figure(force.rms);
  json["mean_newton"] = figure(force.mean);
  json["counts_as"] = texture.counts_as;
  json["period_m"] = figure(force.period);
  json["orientation_rad"] = direction_figure(force.orientation);
  json["anisotropy"] = figure(force.anisotropy);
  json["regularity"] = figure(force.regularity);
  if (const auto& met = texture.encoder_pattern)
    json["encoder_pattern"] = {{"period_m", figure(met->period)},
                               {"orientation_rad", direction_figure(met->orientation)}};
  auto& waves = json["waves"] = nlohmann::ordered_json::array();
  for (const ReliefWave& wave : force.waves)
    waves.push_back({{"period_m", figure(wave.period)},
                     {"orientation_rad", direction_figure(wave.orientation)},
                     {"share", figure(wave.share)}});
  if (force.crest > 0) json["crest"] = figure(force.crest);
  json["steepness_per_m"] = figure(force.steepness);
  json["transitions_per_m"] = figure(force.transitions);
  return json;
}

nlohmann::ordered_json to_json(const MeasuredShaking& shaking) {
  return {{"max_m_per_s2", figure(shaking.max)},
          {"p99_m_per_s2", figure(shaking.p99)},
          {"rms_m_per_s2", figure(shaking.rms)},
          {"lowest_hz", figure(shaking.lowest)},
          {"highest_hz", figure(shaking.highest)}};
}

void add_force(nlohmann::ordered_json& json, const Description& description) {
  json["force"] = {{"max_newton", figure(description.force.max_newton)},
                   {"p99_newton", figure(description.force.p99_newton)},
                   {"rms_newton", figure(description.force.rms_newton)},
                   {"max_may_be_larger", description.force.may_be_larger},
                   {"over_time", description.force.over_seconds > 0},
                   {"over_seconds", figure(description.force.over_seconds)},
                   {"bound_newton", figure(description.bound.newton)},
                   {"found_newton", figure(description.bound.found.newton)},
                   {"limit_matters", description.limit_matters}};
  json["grade"] = to_json(description.grade);
  json["stiffness"] = {{"max_newton_per_metre", figure(description.grade.stiffness)},
                       {"jumps", description.grade.jumps},
                       {"at", to_json(description.grade.stiffest)}};
}

nlohmann::ordered_json to_json(const OutsideRange& outside) {
  const auto end = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(figure(value)) : nlohmann::ordered_json(nullptr);
  };
  return {{"quantity", outside.quantity}, {"value_si", figure(outside.value)}, {"low_si", end(outside.low)},
          {"high_si", end(outside.high)}, {"assumed", outside.assumed},        {"words", in_words(outside)}};
}

nlohmann::ordered_json to_json(const DescribedPercept& percept, const std::vector<Parameter>& parameters) {
  using Json = nlohmann::ordered_json;
  Json entry;
  entry["asked"] = percept.asked ? Json(figure(*percept.asked)) : Json(nullptr);
  entry["asked_evidence"] = percept.claimed ? Json(evidence_word(*percept.claimed)) : Json(nullptr);
  entry["level"] = figure(percept.level);
  entry["evidence"] = evidence_word(percept.evidence());
  entry["evidence_of"] = {{"slope", evidence_word(percept.slope)},
                          {"anchor", evidence_word(percept.anchor)},
                          {"handle", evidence_word(percept.handle)},
                          {"domain", percept.domain ? evidence_word(*percept.domain) : "not stated"}};
  entry["domain"] = percept.domain_why;
  Json& outside = entry["outside"] = Json::array();
  for (const OutsideRange& each : percept.outside) outside.push_back(to_json(each));
  entry["assumed"] = percept.assumed;
  entry["map"] = percept.map;
  entry["measured_on"] = percept.device;
  entry["source"] = percept.source;
  entry["magnitude"] = figure(percept.magnitude);
  entry["low"] = figure(percept.intervals.means.low);
  entry["high"] = figure(percept.intervals.means.high);
  entry["means_differ_more"] = percept.intervals.means_differ_more;
  const auto& people = percept.intervals.people;
  entry["individual_low"] = people ? nlohmann::ordered_json(figure(people->low)) : nullptr;
  entry["individual_high"] = people ? nlohmann::ordered_json(figure(people->high)) : nullptr;
  entry["near_threshold"] = percept.near_threshold;
  entry["carrier"] = percept.carrier;
  entry["size"] = figure(percept.amplitude);
  entry["unit"] = percept.unit;
  if (percept.unit == "N") entry["amplitude_newton"] = figure(percept.amplitude);
  if (percept.solved) entry["solved_size"] = figure(percept.aimed);
  entry["read"] = percept.readable;
  entry["read_from_force"] = percept.extracted;
  if (!percept.realisation.empty()) entry["realised_as"] = percept.realisation;
  if (!percept.settings.empty()) {
    Json& settings = entry["settings"] = Json::array();
    for (const DescribedPercept::Setting& each : percept.settings)
      settings.push_back({{"asked", figure(each.asked)}, {"level", figure(each.reads)}});
  }
  if (!percept.ends.empty()) {
    Json& ends = entry["at_ends"] = Json::array();
    for (const DescribedPercept::End& each : percept.ends)
      ends.push_back({{"parameter", parameters[each.parameter].name},
                      {"value_si", figure(each.value)},
                      {"level", figure(each.reads)}});
  }
  entry["saturated"] = percept.saturated;
  entry["outside_validity"] = percept.outside_validity();
  entry["alone"] = percept.alone;
  return entry;
}

/// What the program remembers and shows.
void add_memory_and_marks(nlohmann::ordered_json& json, const Description& description) {
  auto& states = json["states"] = nlohmann::ordered_json::array();
  for (const auto& state : description.states)
    states.push_back({{"name", state.name}, {"min_si", figure(state.low)}, {"max_si", figure(state.high)}});
  auto& memories = json["memories"] = nlohmann::ordered_json::array();
  for (const auto& grid : description.memories)
    memories.push_back({{"name", grid.name},
                        {"min_si", figure(grid.low)},
                        {"max_si", figure(grid.high)},
                        {"initial_si", figure(grid.initial)},
                        {"columns", grid.columns},
                        {"rows", grid.rows},
                        {"bytes", bytes_of(grid)}});
  auto& shows = json["shows"] = {{"relief", description.shows_relief}, {"colour", description.shows_colour}};
  auto& marks = shows["marks"] = nlohmann::ordered_json::array();
  for (const auto& mark : description.marks)
    marks.push_back({{"kind", mark_word(mark.kind)}, {"colour", fmt::format("#{:06x}", mark.colour & 0xffffff)}});
}

void add_code(nlohmann::ordered_json& json, const Description& description) {
  json["instructions"] = description.code.tick;
  auto& sections = json["sections"];
  const auto section = [&](const char* name, std::size_t instructions, long cost) {
    sections[name] = {{"instructions", instructions}, {"cost", cost}};
  };
  const auto& code = description.code;
  section("setup", code.setup, code.setup_cost);
  section("peak", code.peaks, code.peak_cost);
  section("enter", code.enter, code.enter_cost);
  section("tick", code.tick, code.tick_cost);
  section("picture", code.picture, code.picture_cost);
  section("frame", code.frame, code.frame_cost);
  json["cost"] = description.code.tick_cost;
  if (description.coarseness > 1) json["coarseness"] = description.coarseness;
  json["bytes"] = description.bytes;
}

/// What resists along one axis, what pushes everywhere alike, and what no percept tells; only what there is.
void add_other_forces(nlohmann::ordered_json& json, const Description& description) {
  for (const Description::Directed& each : description.directed)
    json["directed"][each.name] = {{"greatest", figure(each.size.greatest)},
                                   {"across", figure(each.size.across)},
                                   {"axis", {direction_figure(each.size.axis.x), direction_figure(each.size.axis.y)}},
                                   {"unit", each.unit}};
  if (const glm::dvec2 push = description.constant_push; push != glm::dvec2(0))
    json["constant_push_newton"] = {figure(push.x), figure(push.y)};
  if (description.rest) json["spring_rest_m"] = {figure(description.rest->x), figure(description.rest->y)};
  if (description.sway.amplitude > 0)
    json["sway"] = {{"amplitude_newton", figure(description.sway.amplitude)},
                    {"frequency_hz", figure(description.sway.frequency)}};
  if (description.sway.course) json["sway"].update(course_json(*description.sway.course));
  if (!description.sway.parts.empty()) json["sway"]["parts"] = parts_json(description.sway.parts);
  if (!description.vibration_parts.empty()) json["vibration_parts"] = parts_json(description.vibration_parts);
  if (description.vibration_course) json["vibration_course"] = course_json(*description.vibration_course);
  if (description.noise.amplitude > 0) json["noise_in_time_newton"] = figure(description.noise.amplitude);
  if (description.uneven.least)
    json["swing_by_place"] = {{"least_newton", figure(*description.uneven.least)},
                              {"most_newton", figure(description.uneven.amplitude)}};
  add_motion(json, description.motion);
  add_mass(json, description.mass);
  add_held(json, description.held);
  const auto other = [&](const char* name, double force) {
    if (force > 0) json["other_force_newton"][name] = figure(force);
  };
  other("button", description.other.button);
  other("slowly", description.other.slowly);
  other("remembered", description.other.remembered);
  other("moving", description.other.moving);
  other("later", description.other.later);
  if (description.spring_force > 0) json["spring_force_newton"] = figure(description.spring_force);
  if (description.spring_beyond > 0) json["spring_beyond_newton_per_metre"] = figure(description.spring_beyond);
  if (description.swirl != 0) json["swirl_newton_per_metre"] = figure(description.swirl);
  if (description.travel) json["travel_rad"] = direction_figure(*description.travel);
  if (const ComingForce& coming = description.coming; coming.after > 0) {
    json["coming"] = {{"after_s", figure(coming.after)}, {"goes", coming.goes}};
    if (coming.later_swing > 0)
      json["coming"]["later_swing"] = {{"amplitude_newton", figure(coming.later_swing)},
                                       {"frequency_hz", figure(coming.later_rate)}};
    if (coming.later_push != glm::dvec2(0))
      json["coming"]["later_push_newton"] = {figure(coming.later_push.x), figure(coming.later_push.y)};
  }
  other("aside", description.aside);
  other("unread", description.unread);
  other("small_feature", description.small_feature);
}

nlohmann::ordered_json to_json(const Description::Wall& wall) {
  nlohmann::ordered_json json = {
      {"at", {figure(wall.face.place.x), figure(wall.face.place.y)}},
      {"inward", {direction_figure(wall.face.inward.x), direction_figure(wall.face.inward.y)}},
      {"stiffness", figure(wall.face.stiffness)},
      {"preload_newton", figure(wall.face.preload)},
      {"depth_m", figure(wall.depth.depth)},
      {"max_newton", figure(wall.depth.newton)}};
  if (wall.face.power != 1) json["power"] = wall.face.power > 0 ? nlohmann::ordered_json(figure(wall.face.power)) : nullptr;
  if (wall.face.radius > 0)
    json["round"] = {{"centre", {figure(wall.face.centre.x), figure(wall.face.centre.y)}},
                     {"radius_m", figure(wall.face.radius)},
                     {"within", wall.face.fills}};
  return json;
}

/// Walls, and lines where the force jumps; only what there is.
void add_obstacles(nlohmann::ordered_json& json, const Description& description) {
  if (description.wall) json["wall"] = to_json(*description.wall);
  for (const Description::Wall& each : description.more_walls) json["more_walls"].push_back(to_json(each));
  for (const StaticStep& each : description.steps)
    json["steps"].push_back({{"at", {figure(each.offset * each.way.x), figure(each.offset * each.way.y)}},
                             {"across", {direction_figure(each.way.x), direction_figure(each.way.y)}},
                             {"newton", {figure(each.change.x), figure(each.change.y)}},
                             {"width_m", figure(2 * each.width)}});
}

nlohmann::ordered_json to_json(const Description& description) {
  nlohmann::ordered_json json;
  json["material"] = description.material;
  json["device"] = description.device.name;
  auto& representative = json["representative"] = nlohmann::ordered_json::object();
  for (const auto& [key, values] : description.layers.representative) {
    if (key.starts_with("called") || key == "feels" || key == "source" || key == "replaces")
      representative[key] = values;
    else
      representative[key] = values.empty() ? "" : values.front();
  }
  json["documentation"] = description.layers.documentation;
  auto& percepts = json["percepts"] = nlohmann::ordered_json::object();
  for (const auto& percept : description.percepts) percepts[percept.name] = to_json(percept, description.parameters);
  if (!description.no_percept.empty()) json["no_percept"] = description.no_percept;
  if (!description.no_texture.empty()) json["no_texture"] = description.no_texture;
  if (description.texture) json["texture"] = to_json(*description.texture);
  add_obstacles(json, description);
  add_other_forces(json, description);
  json["fates"] = to_json(description.fates);
  if (description.shaking) {
    json["shaking"] = to_json(*description.shaking);
    json["grade"] = {{"name", "does not apply"}};
  } else {
    add_force(json, description);
  }
  auto& parameters = json["parameters"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    auto& each = parameters.emplace_back(to_json(description.parameters[i]));
    if (i < description.cuts.size())
      for (const CutRange& cut : description.cuts[i])
        each[cut.above ? "cut_from_si" : "cut_up_to_si"] = figure(cut.value);
  }
  if (description.not_searched > 0) json["parameters_not_searched"] = description.not_searched;
  add_memory_and_marks(json, description);
  json["patch"] = {{"width_m", figure(description.patch.width)},
                   {"height_m", figure(description.patch.height)},
                   {"rim_m", figure(description.patch.rim)}};
  add_code(json, description);
  return json;
}

}  // namespace

std::string descriptions_json(const std::vector<Description>& descriptions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& description : descriptions) json.push_back(to_json(description));
  return json_lines(descriptions.size() == 1 ? json.front() : json);
}

}  // namespace wale
