#pragma once

#include "wale/shape.h"
#include "wale/shape.hpp"

struct WaleShape {
  wale::Shape shape;
};
