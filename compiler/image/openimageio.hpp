#pragma once

// OpenImageIO's headers make fmt header-only, which compiles the whole of it in every file that includes them: half of
// such a file's build time. Whoever includes fmt first gets the library.
// clang-format off
#include <fmt/format.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
// clang-format on
