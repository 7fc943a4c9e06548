// Pictures made smaller by a whole factor.
#pragma once

#include "image/image.h"

namespace goniochrome::image {

// Makes `into` the picture whose pixels are the means of factor x factor pixels of `from`. `factor` divides its width
// and its height. Memory that `into` has is used again.
void shrink(const Image& from, int factor, Image& into);

}  // namespace goniochrome::image
