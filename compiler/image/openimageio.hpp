#pragma once

// OpenImageIO's headers make fmt header-only, so that all of fmt is compiled in every file that includes them: half of
// such a file's build time. Including fmt first uses its library instead.
// clang-format off
#include <fmt/format.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
// clang-format on
