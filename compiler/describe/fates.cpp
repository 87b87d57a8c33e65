#include "compiler/describe/fates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/describe/fates_json.hpp"
#include "compiler/text/json_text.hpp"

namespace wale {
namespace {

constexpr std::size_t first_column = 22, column = 16;

struct Row {
  std::string name;
  bool percept = false;

  friend bool operator==(const Row&, const Row&) = default;
};

std::string cell(const DeviceFates& device, const Row& row) {
  if (!device.fates) return "-";
  for (const DescribedFate& described : *device.fates) {
    const FateRecord& each = described.record;
    if (Row{each.name, each.percept} != row) continue;
    const bool to_level = each.percept && each.fate == Fate::saturated;
    return to_level ? fmt::format("saturated {:.2f}", each.given) : fate_word(each.fate);
  }
  return "";
}

void write_material(std::string& text, const std::vector<const DeviceFates*>& devices) {
  const auto add_line = [&](const std::string& line) { text += line.substr(0, line.find_last_not_of(' ') + 1); };
  std::string head = fmt::format("{:<{}}", devices.front()->material, first_column);
  for (const DeviceFates* device : devices) head += fmt::format("{:<{}}", device->device, column);
  add_line(head);
  std::vector<const DeviceFates*> buildable;
  std::ranges::copy_if(devices, std::back_inserter(buildable),
                       [](const DeviceFates* each) { return bool(each->fates); });
  std::vector<Row> rows;
  for (const bool percepts : {true, false})
    for (const DeviceFates* device : buildable)
      for (const DescribedFate& each : *device->fates)
        if (const Row row{each.record.name, each.record.percept};
            row.percept == percepts && std::ranges::find(rows, row) == rows.end())
          rows.push_back(row);
  for (const Row& row : rows) {
    std::string line = fmt::format("\n  {:<{}}", row.name, first_column - 2);
    for (const DeviceFates* device : devices) line += fmt::format("{:<{}}", cell(*device, row), column);
    add_line(line);
  }
  text += '\n';
  for (const DeviceFates* device : buildable)
    for (const DescribedFate& each : *device->fates)
      if (!each.changes.empty())
        text += fmt::format("  {} on {}{}\n", each.record.name, device->device, ": " + changes_text(each));
  for (const DeviceFates* device : devices)
    if (!device->fates) text += fmt::format("  not for {}: {}\n", device->device, device->fates.error().sentence);
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<DescribedFate>& fates) {
  nlohmann::ordered_json percepts = nlohmann::ordered_json::object(), physics = percepts;
  for (const DescribedFate& described : fates) {
    const FateRecord& each = described.record;
    nlohmann::ordered_json entry = {{"fate", fate_word(each.fate)}};
    if (each.percept) entry["asked"] = figure(each.asked), entry["given"] = figure(each.given);
    entry["reason"] = each.reason;
    for (const FateChange& change : described.changes)
      entry["changes"].push_back({{"fate", fate_word(change.fate)},
                                  {"parameter", change.parameter},
                                  {change.above ? "above" : "below", figure(change.value)},
                                  {"unit", change.unit}});
    (each.percept ? percepts : physics)[each.name] = std::move(entry);
  }
  return {{"percepts", std::move(percepts)}, {"physics", std::move(physics)}};
}

std::string fates_text(const std::vector<DeviceFates>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size();) {
    std::vector<const DeviceFates*> devices;
    for (const std::string& material = all[i].material; i < all.size() && all[i].material == material; ++i)
      devices.push_back(&all[i]);
    if (!text.empty()) text += '\n';
    write_material(text, devices);
  }
  return text;
}

std::string fates_json(const std::vector<DeviceFates>& all) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const DeviceFates& each : all) {
    auto& entry = json[each.material][each.device];
    if (each.fates)
      entry = to_json(*each.fates);
    else
      entry = {{"refused", each.fates.error().sentence}};
  }
  return json_lines(json);
}

}  // namespace wale
