#ifndef WALE_SHAPE_H
#define WALE_SHAPE_H

#include "wale/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What part of its rectangle a patch covers. Coordinates are m from the patch's centre; y grows towards the top. A patch of
   another size than the shape's stretches it. It is read when a patch is added, and may be freed afterwards. Any number of
   threads may use it at once. */
typedef struct WaleShape WaleShape;

/* Half axes, m, above 0 and at most 10. Error: malformed_value. */
WALE_API WaleCode wale_shape_ellipse(float half_width, float half_height, WaleShape** shape, WaleError** error);
/* 3 to 256 corners within 10 m, in either sense of rotation. Error: malformed_value, also if sides meet elsewhere than at a
   common corner. */
WALE_API WaleCode wale_shape_polygon(const WaleVector* corners, size_t count, WaleShape** shape, WaleError** error);
/* `columns` times `rows` cells, 4096 of each at most, row by row from the top left; those that are not 0 belong to the shape,
   each a square with this side, m. The picture's middle is the patch's centre. Error: malformed_value, also if no cell is
   set. */
WALE_API WaleCode wale_shape_mask(const uint8_t* cells, size_t columns, size_t rows, float side, WaleShape** shape,
                                  WaleError** error);
WALE_API void wale_shape_free(WaleShape* shape);

/* The width and height of the smallest rectangle around the patch's centre that holds it, m; 0, 0 for NULL. */
WALE_API WaleVector wale_shape_size(const WaleShape* shape);
/* The distance of a point to its edge, m: positive inside, negative outside. For NULL not-a-number. */
WALE_API float wale_shape_edge(const WaleShape* shape, WaleVector point);

#ifdef __cplusplus
}
#endif

#endif
