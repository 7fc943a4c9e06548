// The light of a view by lobes where no surface is in the way, by the maps of an environment: pictures of any number of
// paints follow from it by TransportShader, and none of the maps is looked up again.
// goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <memory>
#include <vector>

#include "render/gbuffer.h"
#include "render/path/lobe_transport.h"

namespace goniochrome::render {

// A transport without bounced light. The samples of the pixels, one G-buffer of the same size for each, lie below each
// other in it: its height is theirs times their number.
LobeTransport open_transport(const OpenLight& light, const LobeColumns& columns, const WornPaints& worn,
                             const std::vector<std::shared_ptr<const Gbuffer>>& samples);

// The mean of pictures that lie below each other in `stacked`, `count` of them, R G B A.
void put_mean(const image::Image& stacked, int count, image::Image& picture);

}  // namespace goniochrome::render
