#pragma once

#include "compiler/prove/domain.hpp"
#include "wale/program.hpp"

namespace wale {

/// `whole_domain` with states and cells narrowed to what a run can come to, from entering on: ranges that what they
/// begin with lies in and that no tick leaves, whatever the hand does and however parameters are moved in between. By
/// following a tick over ranges that grow, then to their bounds where they go on growing, and then shrink again as far
/// as they still hold.
Domain reachable_domain(const Program& program);

}  // namespace wale
