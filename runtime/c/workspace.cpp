#include "runtime/c/workspace.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <limits>
#include <span>

#include "runtime/c/program.hpp"
#include "runtime/c/shape.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"

using namespace wale::c;

namespace {

/// Patch `index` of a workspace. Errors: it is NULL, or has no such patch.
wale::Result<const wale::WorkspacePatch*> patch_of(const WaleWorkspace* workspace, const char* argument,
                                                   std::size_t index) {
  if (auto given = is_given("workspace", workspace); !given) return std::move(given).error();
  const auto& all = workspace->workspace.patches;
  if (index >= all.size()) return about_argument(argument, "it has only " + std::to_string(all.size()), "count from 0");
  return &all[index];
}

}  // namespace

WaleCode wale_workspace_load(const void* bytes, size_t length, WaleWorkspace** workspace, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("workspace", workspace); !clear) return clear;
    if (auto given = is_given("bytes", bytes); !given) return given;
    auto loaded = wale::Workspace::load(std::span(static_cast<const std::byte*>(bytes), length));
    if (!loaded) return about_bytes(std::move(loaded).error());
    hand_out(std::unique_ptr<WaleWorkspace>(new WaleWorkspace{*std::move(loaded)}), workspace);
    return {};
  });
}

void wale_workspace_free(WaleWorkspace* workspace) { free_handle(workspace); }

WaleCode wale_workspace_bytes(const WaleWorkspace* workspace, void* to, size_t capacity, size_t* length,
                              WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("workspace", workspace); !given) return given;
    if (auto given = is_given("length", length); !given) return given;
    *length = 0;
    const auto bytes = wale::write_workspace(workspace->workspace);
    if (to != nullptr && capacity >= bytes.size()) std::memcpy(to, bytes.data(), bytes.size());
    *length = bytes.size();
    return {};
  });
}

WaleCode wale_workspace_details(const WaleWorkspace* workspace, WaleWorkspaceDetails* details, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("workspace", workspace); !given) return given;
    if (auto sized = is_sized("details", details); !sized) return sized;
    const wale::Workspace& known = workspace->workspace;
    const bool is_empty = known.patches.empty();
    write_sized(details,
                {.name = text_of(known.name),
                 .documentation = text_of(known.documentation),
                 .device = is_empty ? text_of("") : text_of(known.patches.front().program.description().device.name),
                 .patches = known.patches.size(),
                 .warnings = workspace->warnings.size()});
    return {};
  });
}

WaleCode wale_workspace_patch(const WaleWorkspace* workspace, size_t index, WaleWorkspacePatch* patch,
                              WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    const auto known = patch_of(workspace, "index", index);
    if (!known) return known.error();
    if (auto sized = is_sized("patch", patch); !sized) return sized;
    const wale::PatchOptions& options = (*known)->options;
    const auto statement =
        index < workspace->statements.size() ? workspace->statements[index] : std::pair<std::size_t, std::size_t>(0, 0);
    write_sized(patch, {.name = text_of((*known)->name),
                        .made_of = text_of((*known)->made_of),
                        .x = options.at.x,
                        .y = options.at.y,
                        .width = options.size->width,
                        .height = options.size->height,
                        .rim = options.size->rim,
                        .has_shape = !options.shape.is_rectangle(),
                        .marks = (*known)->marks.size(),
                        .text_begin = statement.first,
                        .text_end = statement.second});
    return {};
  });
}

WaleCode wale_workspace_mark(const WaleWorkspace* workspace, size_t patch, size_t index, WaleWorkspaceMark* mark,
                             WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    const auto known = patch_of(workspace, "patch", patch);
    if (!known) return known.error();
    if (auto sized = is_sized("mark", mark); !sized) return sized;
    if (auto there = is_there(index, (*known)->marks.size()); !there) return there;
    const wale::WorkspaceMark& made = (*known)->marks[index];
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    write_sized(mark, {.slider = text_of(made.slider),
                       .says = text_of(made.says),
                       .low = made.low.value_or(none),
                       .high = made.high.value_or(none),
                       .is_percept = made.is_percept});
    return {};
  });
}

WaleCode wale_workspace_program(const WaleWorkspace* workspace, size_t patch, WaleProgram** program,
                                WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("program", program); !clear) return clear;
    const auto known = patch_of(workspace, "patch", patch);
    if (!known) return known.error();
    hand_out(std::make_unique<WaleProgram>(WaleProgram{(*known)->program}), program);
    return {};
  });
}

WaleCode wale_workspace_shape(const WaleWorkspace* workspace, size_t patch, WaleShape** shape, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("shape", shape); !clear) return clear;
    const auto known = patch_of(workspace, "patch", patch);
    if (!known) return known.error();
    const wale::Shape& made = (*known)->options.shape;
    if (!made.is_rectangle()) hand_out(std::make_unique<WaleShape>(WaleShape{made}), shape);
    return {};
  });
}

const WaleError* wale_workspace_warning(const WaleWorkspace* workspace, size_t index) {
  if (workspace == nullptr || index >= workspace->warnings.size()) return nullptr;
  return workspace->warnings[index].get();
}

WaleCode wale_stage_add_workspace(WaleStage* stage, const WaleWorkspace* workspace, WalePatch** patches,
                                  WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("workspace", workspace); !given) return given;
    if (patches != nullptr) std::fill_n(patches, workspace->workspace.patches.size(), nullptr);
    if (auto given = is_stage(stage); !given) return given;
    std::deque<HandleToBe<WalePatch>> handles;
    for (std::size_t i = 0; patches != nullptr && i < workspace->workspace.patches.size(); ++i)
      handles.emplace_back(&patches[i]);
    auto put = wale::put_on(stage->stage, workspace->workspace);
    if (!put) return std::move(put).error();
    for (std::size_t i = 0; i < handles.size(); ++i) {
      handles[i]->patch = std::move((*put)[i]);
      handles[i].give();
    }
    return {};
  });
}
