// `wale feel FILE --workspace NAME`: all patches of a workspace at once.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "calibration/command/feel_run.hpp"
#include "compiler/command/print.hpp"

namespace wale::command {

int feel_workspace(const FeelOptions& options, const std::atomic<bool>& stop) {
  const auto prepared_run = prepared(options, stop);
  if (!prepared_run) return prepared_run.status();
  const Workspace& workspace = prepared_run->workspace;
  auto table = table_of(options);
  if (!table) return refuse(table.error());
  auto felt = open_prepared(options, *prepared_run, stop);
  if (!felt) return felt.status();
  Stage stage(*felt->device, stage_options(options, felt->manner()));
  auto patches = put_on(stage, workspace);
  if (!patches) return refuse(patches.error());
  VisitedPatches visited(stage, *std::move(patches));

  const bool live = isatty(fileno(stderr)) != 0;
  const bool vibrates = prepared_run->material.program.description().vibrates();
  RunOptions run = run_options(options, stop);
  run.progress = [&](const Now& now) {
    visited.poll();
    if (live) print_as_is(stderr, "\r" + progress_line(now, vibrates));
  };
  const auto result = stage.run(run);
  visited.poll();
  if (live) print_as_is(stderr, "\r\033[K");
  if (!result) {
    Error error = result.error();
    if (error.place.name == "seconds") error.place.name = "--seconds";
    return refuse(error);
  }
  Result<> tabled;
  if (*table) {
    write_csv((*table)->stream(), result->record);
    tabled = (*table)->finish();
  }
  const WorkspaceReport report = visited.report(workspace, *result, felt->manner());
  felt->device.reset();  // the pointer restores the terminal
  print_out(options.json ? workspace_report_json(report) : workspace_report_text(report));
  if (!tabled) return refuse(tabled.error());
  return result->record_problem ? refuse(*result->record_problem) : done;
}

}  // namespace wale::command
