#include "calibration/feel/felt_workspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

VisitedPatches::VisitedPatches(Stage& stage, std::vector<Patch> patches) : stage_(stage), patches_(std::move(patches)) {
  stage_.on_contact([this](const ContactEvent& contact) {
    if (contact.kind == ContactKind::enter || contact.kind == ContactKind::leave) contacts_.push_back(contact);
  });
}

WorkspaceReport VisitedPatches::report(const Workspace& workspace, const RunResult& run, RunManner manner) const {
  const double tick = run.record.seconds_per_tick;
  WorkspaceReport report{.workspace = workspace.name,
                         .manner = std::move(manner),
                         .seconds = tick * static_cast<double>(run.record.ticks.size()),
                         .outside = 0,
                         .ticks_run = run.ticks_run,
                         .ticks_missed = run.ticks_missed,
                         .patches = {}};
  for (const WorkspacePatch& each : workspace.patches) report.patches.push_back({.name = each.name});
  std::vector<double> squares(report.patches.size());
  std::size_t next = 0;
  std::optional<std::size_t> on;
  const double half = 0.5 * tick;  // a contact and its tick have one time, but for rounding
  for (const TickRecord& each : run.record.ticks) {
    for (; next < contacts_.size() && contacts_[next].time <= each.time + half; ++next) {
      const auto touched = std::ranges::find(patches_, contacts_[next].patch);
      if (touched == patches_.end()) continue;
      const auto index = static_cast<std::size_t>(touched - patches_.begin());
      const bool enters = contacts_[next].kind == ContactKind::enter;
      if (enters) ++report.patches[index].entries;
      if (enters || on == index) on = enters ? std::optional(index) : std::nullopt;
    }
    if (!on) {
      report.outside += tick;
      continue;
    }
    PatchVisits& visits = report.patches[*on];
    const double force = run.record.vibrates ? std::abs(each.force.x) : glm::length(each.force);
    visits.seconds += tick;
    visits.largest = std::max(visits.largest, force);
    squares[*on] += force * force * tick;
  }
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (report.patches[i].seconds > 0) report.patches[i].typical = std::sqrt(squares[i] / report.patches[i].seconds);
  return report;
}

std::string workspace_report_text(const WorkspaceReport& report) {
  std::string text =
      readable("workspace {} on {}, hand {}: {:.4g} s, {} ticks, {} missed\n", report.workspace, report.manner.device,
               report.manner.hand, report.seconds, report.ticks_run, report.ticks_missed);
  std::size_t widest = 0;
  for (const PatchVisits& each : report.patches) widest = std::max(widest, each.name.size());
  for (const PatchVisits& each : report.patches) {
    std::string name = each.name;
    name.resize(widest, ' ');
    text += "  " + name + "  ";
    text += each.entries == 0 ? std::string("never touched\n")
                              : readable("{} time{}, {:.2f} s; largest {:.3f} N, RMS {:.3f} N\n", each.entries,
                                         each.entries == 1 ? "" : "s", each.seconds, each.largest, each.typical);
  }
  return text + readable("  beside all patches {:.2f} s\n", report.outside);
}

std::string workspace_report_json(const WorkspaceReport& report) {
  nlohmann::ordered_json patches = nlohmann::ordered_json::array();
  for (const PatchVisits& each : report.patches)
    patches.push_back({{"name", each.name},
                       {"entries", each.entries},
                       {"seconds", each.seconds},
                       {"max_newton", each.largest},
                       {"rms_newton", each.typical}});
  return json_lines(nlohmann::ordered_json{{"workspace", report.workspace},
                                           {"device", report.manner.device},
                                           {"hand", report.manner.hand},
                                           {"seconds", report.seconds},
                                           {"outside_s", report.outside},
                                           {"ticks", report.ticks_run},
                                           {"missed", report.ticks_missed},
                                           {"patches", std::move(patches)}});
}

}  // namespace wale
