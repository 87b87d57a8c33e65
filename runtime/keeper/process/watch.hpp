#pragma once

#include "runtime/keeper/keeper_board.hpp"
#include "runtime/keeper/process/device_node.hpp"

namespace wale::keeper {

/// Watches over the owner of a device until it says that it is over, or is dead and the device has been let go.
/// `owner` is a pidfd of its process; `wake` an eventfd by which it calls. Allocates nothing.
void watch(KeeperBoard& board, DeviceNode& node, int owner, int wake);

}  // namespace wale::keeper
