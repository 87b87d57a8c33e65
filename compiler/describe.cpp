#include "compiler/describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace wale {

namespace {

constexpr double normal_95 = 1.96;  // standard deviations on either side that hold 95 % of a normal distribution

/// A figure with the digits that single precision holds: 0.6, not 0.60000002384.
double figure(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.6g}", value)) : value; }

/// A parameter's value in its author's unit.
double shown(float value, double unit_in_si) { return figure(value / unit_in_si); }

DescribedPercept describe_percept(const Bank& bank, std::size_t index) {
  const PatchProgram& program = bank.program().description();
  const PerceptRecord& record = program.percepts[index];
  DescribedPercept percept{.name = record.name,
                           .carrier = record.carrier,
                           .asked = {},
                           .slope = record.slope,
                           .anchor = record.anchor,
                           .handle = record.handle,
                           .worst = std::max({record.slope, record.anchor, record.handle}),
                           .map = record.map,
                           .device = record.device,
                           .source = record.source};
  const float aimed = amplitude(bank, index);
  const float most = static_cast<float>(program.device.force_newton);
  percept.saturated = aimed > most;
  percept.amplitude = std::min(aimed, most);
  const Prediction prediction = predict(bank, index, static_cast<float>(percept.amplitude));
  percept.level = prediction.level;
  percept.magnitude = prediction.magnitude;
  percept.low = percept.level * std::pow(10, -normal_95 * record.scatter);
  percept.high = percept.level * std::pow(10, normal_95 * record.scatter);
  if (record.parameter) percept.asked = bank.registers()[program.first_parameter() + *record.parameter];
  constexpr float rounding = 1e-5f;
  percept.outside_validity =
      percept.amplitude < record.valid_low * (1 - rounding) || percept.amplitude > record.valid_high * (1 + rounding);
  return percept;
}

std::string heading(const Description& description) {
  for (const auto& [key, values] : description.layers.representative)
    if (key == "title" && !values.empty()) return fmt::format("{} ({})", values.front(), description.material);
  return description.material;
}

void write_percepts(std::string& text, const Description& description) {
  text += "\nfeels\n";
  if (description.percepts.empty()) {
    text += "  none that can be read: its force is not one texture\n";
    return;
  }
  for (const auto& percept : description.percepts) {
    text += fmt::format("  {:<12} {:.2f}   (95 % of such means: {:.2f} .. {:.2f}; magnitude {:.3g})\n", percept.name,
                        percept.level, percept.low, percept.high, percept.magnitude);
    text += fmt::format(
        "  {:<12} {} {:.3f} N{}\n", "", percept.carrier, percept.amplitude,
        percept.asked ? fmt::format(", solved for {} {:.3g}", percept.name, *percept.asked) : ", fixed by the author");
    if (percept.saturated)
      text += fmt::format("  {:<12} saturated: `{}` cannot push harder\n", "", description.device.name);
    if (percept.outside_validity) text += fmt::format("  {:<12} outside what was measured\n", "");
    text += fmt::format("  {:<12} evidence: slope {}, anchor {}, handle {}\n", "", evidence_word(percept.slope),
                        evidence_word(percept.anchor), evidence_word(percept.handle));
    text += fmt::format("  {:<12} {} ({}, on {})\n", "", percept.source, percept.map, percept.device);
  }
}

nlohmann::ordered_json to_json(const Description& description) {
  nlohmann::ordered_json json;
  json["material"] = description.material;
  json["device"] = description.device.name;
  auto& representative = json["representative"] = nlohmann::ordered_json::object();
  for (const auto& [key, values] : description.layers.representative) {
    if (key == "called")
      representative[key] = values;
    else
      representative[key] = values.empty() ? "" : values.front();
  }
  auto& percepts = json["percepts"] = nlohmann::ordered_json::object();
  for (const auto& percept : description.percepts) {
    auto& entry = percepts[percept.name];
    entry["level"] = figure(percept.level);
    entry["magnitude"] = figure(percept.magnitude);
    entry["low"] = figure(percept.low);
    entry["high"] = figure(percept.high);
    entry["carrier"] = percept.carrier;
    entry["amplitude_newton"] = figure(percept.amplitude);
    if (percept.asked) entry["asked"] = figure(*percept.asked);
    entry["saturated"] = percept.saturated;
    entry["outside_validity"] = percept.outside_validity;
    entry["evidence"] = evidence_word(percept.worst);
    entry["evidence_of"] = {{"slope", evidence_word(percept.slope)},
                            {"anchor", evidence_word(percept.anchor)},
                            {"handle", evidence_word(percept.handle)}};
    entry["map"] = percept.map;
    entry["measured_on"] = percept.device;
    entry["source"] = percept.source;
  }
  json["force"] = {{"max_newton", figure(description.force.max_newton)},
                   {"p99_newton", figure(description.force.p99_newton)},
                   {"rms_newton", figure(description.force.rms_newton)}};
  auto& parameters = json["parameters"] = nlohmann::ordered_json::array();
  for (const auto& parameter : description.parameters)
    parameters.push_back({{"name", parameter.name},
                          {"unit", parameter.unit},
                          {"value", shown(parameter.value, parameter.unit_in_si)},
                          {"min", shown(parameter.low, parameter.unit_in_si)},
                          {"max", shown(parameter.high, parameter.unit_in_si)},
                          {"description", parameter.description}});
  json["patch"] = {{"width_m", figure(description.patch.width)},
                   {"height_m", figure(description.patch.height)},
                   {"rim_m", figure(description.patch.rim)}};
  json["instructions"] = description.code.tick;
  json["sections"] = {
      {"setup", {{"instructions", description.code.setup}, {"cost", description.code.setup_cost}}},
      {"peak", {{"instructions", description.code.peaks}, {"cost", description.code.peak_cost}}},
      {"tick", {{"instructions", description.code.tick}, {"cost", description.code.tick_cost}}},
      {"picture", {{"instructions", description.code.picture}, {"cost", description.code.picture_cost}}}};
  json["bytes"] = description.bytes;
  return json;
}

}  // namespace

std::string evidence_word(Evidence evidence) {
  switch (evidence) {
    case Evidence::measured: return "measured";
    case Evidence::published: return "published";
    case Evidence::estimated: return "estimated";
    case Evidence::recalled: return "recalled";
    case Evidence::transferred: return "transferred";
  }
  return "unknown";
}

Description describe(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  Description description{
      .material = program.material, .device = program.device, .layers = program.layers, .patch = bank.size()};
  for (std::size_t i = 0; i < program.percepts.size(); ++i) description.percepts.push_back(describe_percept(bank, i));
  description.force = measure(bank);
  description.parameters = program.parameters;
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    description.parameters[i].value = bank.registers()[program.first_parameter() + i];
  auto& code = description.code;
  code.setup = program.setup.size(), code.setup_cost = cost_of(program.setup);
  code.tick = program.tick.size(), code.tick_cost = cost_of(program.tick);
  code.picture = program.picture.code.size(), code.picture_cost = cost_of(program.picture.code);
  for (const auto& peak : program.peaks) {
    code.peaks += peak.code.size();
    code.peak_cost += cost_of(peak.code) * peak.points;
  }
  description.bytes = write_patch_program(program).size();
  return description;
}

std::string description_text(const Description& description) {
  std::string text = fmt::format("{}\n  built for {}, {:.3g} N at {:.4g} Hz\n", heading(description),
                                 description.device.name, description.device.force_newton, description.device.rate);
  for (const auto& [key, values] : description.layers.representative)
    if (key != "title") text += fmt::format("  {:<12} {}\n", key, fmt::join(values, ", "));
  write_percepts(text, description);
  text += fmt::format("\npushes\n  {:.3f} N at most; at rest, over the patch: P99 {:.3f} N, RMS {:.3f} N\n",
                      description.force.max_newton, description.force.p99_newton, description.force.rms_newton);
  text += "\nparameters\n";
  if (description.parameters.empty()) text += "  none\n";
  for (const auto& parameter : description.parameters)
    text += fmt::format("  {:<12} {:<12} {:<20} {}\n", parameter.name,
                        fmt::format("{} {}", shown(parameter.value, parameter.unit_in_si), parameter.unit),
                        fmt::format("{} .. {} {}", shown(parameter.low, parameter.unit_in_si),
                                    shown(parameter.high, parameter.unit_in_si), parameter.unit),
                        parameter.description);
  const auto& code = description.code;
  text += fmt::format("\npatch\n  {:.4g} mm x {:.4g} mm, fading over {:.3g} mm at its edge\n",
                      1e3 * description.patch.width, 1e3 * description.patch.height, 1e3 * description.patch.rim);
  text += fmt::format(
      "\nprogram\n  tick {} instructions (cost {}), setup {} ({}), peaks {} ({:.2g} with all points), picture {} ({}); "
      "{} bytes\n",
      code.tick, code.tick_cost, code.setup, code.setup_cost, code.peaks, static_cast<double>(code.peak_cost),
      code.picture, code.picture_cost, description.bytes);
  return text;
}

std::string descriptions_json(const std::vector<Description>& descriptions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& description : descriptions) json.push_back(to_json(description));
  // Names may hold any text a file brought along; what is no UTF-8 is replaced rather than thrown about.
  return (descriptions.size() == 1 ? json.front() : json)
             .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace wale
