#pragma once

/// All public headers.

#include "wale/library.hpp"
#include "wale/runtime.hpp"
