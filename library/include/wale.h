#ifndef WALE_H
#define WALE_H

/* The C interface of Wale. runtime/C_INTERFACE.md has its conventions; wale/runtime.h is the part without the compiler. */

#include "wale/library.h"
#include "wale/runtime.h"
#include "wale/search.h"

#endif
