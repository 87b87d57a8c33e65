#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/open_file.hpp"

namespace wale {

/// What `wale build --emit` can show, in the order in which a material becomes it.
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

/// A material as it is after a stage, as text; of `tree`, the whole file. Nothing where it does not come that far,
/// which `diagnostics` say. Error: W0801 for a patch program, which has no stage before the listing.
Result<std::optional<std::string>> build_stage(const OpenedFile& opened, const FileRequest& request,
                                               const std::string& material, BuildStage stage, Diagnostics& diagnostics);

}  // namespace wale
