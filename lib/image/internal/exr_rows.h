// The pixels of an EXR part from the bytes of its blocks.
//
// The library undoes what Zip leaves byte by byte through memory, brings all channels of a part into a buffer of its
// own, and converts sample by sample from there. Blocks of scan lines that are plain or packed by Zip are decoded here
// instead: only the channels that are wanted are put together, on all cores. The layout is that of "OpenEXR File
// Layout", openexr.com.
#pragma once

#include <OpenEXR/ImfMultiPartInputFile.h>

#include <string>

#include "image/image.h"

namespace goniochrome::image {

// True if blocks with this header are decoded by read_rows(): scan lines of halves and floats, each with a sample for
// every pixel, plain or packed by Zip.
bool has_rows(const Imf::Header& header);

// Fills `image.data`, which has the size of the part's data window, with the channels that `image` names. Throws as the
// library does where the file is damaged or cut off.
void read_rows(Imf::MultiPartInputFile& file, int index, Image& image);

}  // namespace goniochrome::image
