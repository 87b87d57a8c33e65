#ifndef WALE_RUNTIME_H
#define WALE_RUNTIME_H

/* The runtime without the compiler: patch programs, stages, devices and recordings. */

#include "wale/batch.h"
#include "wale/device.h"
#include "wale/error.h"
#include "wale/loop.h"
#include "wale/program.h"
#include "wale/recording.h"
#include "wale/run.h"
#include "wale/shape.h"
#include "wale/snapshot.h"
#include "wale/stage.h"
#include "wale/workspace.h"

#endif
