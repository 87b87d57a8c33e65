#pragma once

/// The runtime without the compiler: patch programs, stages, devices and recordings.

#include "wale/batch.hpp"
#include "wale/device.hpp"
#include "wale/devices.hpp"
#include "wale/felt.hpp"
#include "wale/loop.hpp"
#include "wale/memory.hpp"
#include "wale/patch.hpp"
#include "wale/picture.hpp"
#include "wale/program.hpp"
#include "wale/record.hpp"
#include "wale/recording.hpp"
#include "wale/run.hpp"
#include "wale/simulated.hpp"
#include "wale/simulated_pad.hpp"
#include "wale/stage.hpp"
#include "wale/trace.hpp"
