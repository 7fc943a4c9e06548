// Pictures made smaller by a whole factor, or larger.
#pragma once

#include "image/image.h"

namespace goniochrome::image {

// Makes `into` the picture whose pixels are the means of factor x factor pixels of `from`. `factor` divides its width
// and its height. Memory that `into` has is used again.
void shrink(const Image& from, int factor, Image& into);

// The picture of that size whose pixels are bilinear between the centers of those of `from`, which reach to its border.
Image enlarged(const Image& from, int width, int height);

}  // namespace goniochrome::image
