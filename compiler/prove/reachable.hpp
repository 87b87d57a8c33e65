#pragma once

#include "compiler/prove/domain.hpp"
#include "wale/program.hpp"

namespace wale {

/// `whole_domain` with states and cells narrowed to what a run can reach from entering on. These ranges contain the
/// initial values, and no tick leaves them, whatever the hand does and however parameters change. The function follows
/// a tick over growing ranges, widens ranges that keep growing to their bounds, and then shrinks them as far as they
/// still hold.
Domain reachable_domain(const Program& program);

}  // namespace wale
