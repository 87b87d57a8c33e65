#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "runtime/c/device.hpp"
#include "runtime/c/program.hpp"
#include "wale/stage.h"
#include "wale/stage.hpp"

struct WaleStage {
  /// `taken` may be null: a stage without a device.
  WaleStage(std::shared_ptr<wale::c::SharedDevice> taken, const wale::DeviceProfile& figures,
            const wale::StageOptions& options)
      : device(std::move(taken)),
        stage(device ? wale::Stage(*device->device, options) : wale::Stage(figures, options)) {}
  ~WaleStage();

  const wale::HomeProcess home;
  std::shared_ptr<wale::c::SharedDevice> device;
  std::atomic<bool> interrupted = false;
  wale::Stage stage;  // ends before its device
};

struct WalePatch {
  wale::Patch patch;
};

struct WalePlacement {
  wale::Placement placement;
};

namespace wale::c {

Result<PatchOptions> read_options(const WalePatchOptions* options);
Result<const Program*> read_program(const WaleProgram* program);
/// The stage of a call. Error: it is NULL.
inline Result<> is_stage(const WaleStage* stage) { return is_given("stage", stage); }
/// The same. Error also in a child of `fork`, whose parent has made it.
Result<> is_stage_here(const WaleStage* stage);

}  // namespace wale::c
