// A picture may carry buffers, which hold what was seen at the center of each pixel. This header adds them to a
// picture, and makes a G-buffer from those of a file. goniochrome-rendering(7), "Samples and buffers".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "image/aov_file.h"
#include "image/image.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace goniochrome::render {

// Adds the channels of one buffer to a picture; 0 where nothing is seen (aspecular: 180).
//   normal     normal.X normal.Y normal.Z, unit, world axes, turned to the viewer
//   aspecular  the angle (deg, 0..180) between the view and the mirror direction of `to_light`
//   lambert    the cosine of the angle between normal and `to_light`, at least 0
//   mask       1 on the mesh
//   part       the number of the part, from 1
// Error (usage): the names there are.
Result<void> add_aov(image::Image& picture, const Gbuffer& gbuffer, const std::string& name, const Vec3& to_light);

// The names of the buffers above.
std::string aov_names();

// Adds the channel `error`: the noise of each pixel as CIEDE2000, one standard deviation.
void add_error(image::Image& picture, const Noise& noise);

// The G-buffer back from the channels normal and part, bit for bit, but for which parts were seen from inside.
// Error: what the file lacks, with the command that makes it; or the pixel that holds no normal or no part.
Result<Gbuffer> gbuffer_of(const image::AovFile& buffers);

// A lamp that the file tells of.
Light light_of(const image::AovLight& light);

}  // namespace goniochrome::render
