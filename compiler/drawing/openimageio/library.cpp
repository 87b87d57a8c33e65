#include "compiler/drawing/cairo/functions.hpp"
#include "compiler/drawing/openimageio/functions.hpp"

/// The one name that is looked for in the library.
extern "C" const wale::ImageLibrary wale_image_library;

const wale::ImageLibrary wale_image_library{wale::openimageio::encode_drawing, wale::cairo::new_canvas,
                                            wale::openimageio::surroundings};
