#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/open_file.hpp"

namespace wale {

/// The stages that `wale build --emit` can show, in their order.
enum class BuildStage { tree, checked, ir, listing, cpp };

struct StageName {
  std::string_view name;
  BuildStage stage;
};

inline constexpr std::array<StageName, 5> stage_names = {{{"tree", BuildStage::tree},
                                                          {"checked", BuildStage::checked},
                                                          {"ir", BuildStage::ir},
                                                          {"listing", BuildStage::listing},
                                                          {"cpp", BuildStage::cpp}}};

/// A material after a stage, as text; for `tree`, the whole file. Empty if an earlier stage fails, which is reported
/// to `diagnostics`. `live` names what stays adjustable in the C++ (`live_parts`). Errors: W0801 for a patch program
/// and a stage before the listing, and for an unknown name in `live`.
Result<std::optional<std::string>> build_stage(const OpenedFile& opened, const FileRequest& request,
                                               const std::string& material, BuildStage stage, Diagnostics& diagnostics,
                                               const std::vector<std::string>& live = {});

}  // namespace wale
