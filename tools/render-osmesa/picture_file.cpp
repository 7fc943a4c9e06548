#include "picture_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/file.h"
#include "base/text.h"
#include "plan_text.h"
#include "render/aov.h"

namespace goniochrome::tool {

namespace {

std::string spelled(const Vec3& v) {
  return fmt::format("{},{},{}", shortest(v.x), shortest(v.y), shortest(v.z));
}

// Describes the data for shading the buffers again: the rays through the pixels, and the light.
void describe_view(const Options& options, const render::Rays& rays, const std::vector<render::Light>& lights,
                   image::Attributes& attributes) {
  attributes["goniochrome:rays"] =
      fmt::format("{};{};{}", spelled(rays.corner), spelled(rays.right), spelled(rays.down));
  if (options.gbuffer.empty()) attributes["goniochrome:eye"] = spelled(rays.eye);  // buffers do not have it
  std::string all;
  for (const render::Light& light : lights)
    all += fmt::format("{}{},{},{}{}", all.empty() ? "" : ";", spelled(light.direction), spelled(light.white),
                       shortest(2 * light.radius_rad / kDegree),
                       light.place ? "," + spelled(light.place->position) + "," + shortest(light.place->distance) : "");
  attributes["goniochrome:lights"] = all;
  attributes["goniochrome:environment"] = options.env;
}

// The 27 coefficients, the last index running fastest.
std::string spelled(const color::ReflectionOperator& reflection) {
  std::string all;
  for (const auto& matrix : reflection.k)
    for (const auto& row : matrix)
      for (const double value : row) all += (all.empty() ? "" : ",") + shortest(value);
  return all;
}

}  // namespace

image::Attributes provenance(const cli::Session& session, const display::Display* display) {
  image::Attributes text = {{"goniochrome:tool", session.tool()},
                            {"goniochrome:version", std::string(cli::Session::version())},
                            {"goniochrome:command", session.command_line()}};
  if (display != nullptr) text[image::kViewAttribute] = display->name();
  return text;
}

Result<std::vector<image::ImagePart>> exr_picture(const Options& options, const Request& request,
                                                  const render::Frame& frame, const render::Scene& scene,
                                                  const DressedMesh& dress, const render::Plan& plan,
                                                  const Exposure& exposure, const render::TransportParts* transport,
                                                  const cli::Session& session) {
  image::ImagePart part{"picture", frame.picture, provenance(session), image::PixelType::kHalf};
  part.attributes["goniochrome:plan"] = json_text(plan_rows(plan));
  part.attributes["goniochrome:engine"] = plan.engine;
  const float gain = static_cast<float>(std::exp2(exposure.stops));
  for (std::size_t i = 0; i < part.image.data.size(); ++i) part.image.data[i] *= i % 4 == 3 ? 1 : gain;
  part.attributes["colorInteropID"] = "lin_rec2020_scene";
  part.attributes["chromaticities"] =
      std::vector<float>{0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F};
  part.attributes["goniochrome:exposure"] = static_cast<float>(exposure.stops);
  part.attributes["goniochrome:whiteLuminance"] = static_cast<float>(exposure.white.luminance);
  part.attributes["goniochrome:automaticExposure"] = static_cast<float>(exposure.automatic);
  // The buffers that a transport is shaded by: an edit reads no others.
  image::ImagePart points{
      image::kPointsName, {part.image.width, part.image.height, 0, {}, {}}, {}, image::PixelType::kFloat};
  part.attributes["goniochrome:samples"] = std::min(request.samples * request.samples_of_point, 16);
  if (!request.aovs.empty()) {
    const Vec3 to_light = scene.lights.empty() ? exposure.white.direction : scene.lights.front().direction;
    for (const std::string& aov : request.aovs) {
      if (aov == "error") {
        render::add_error(part.image, frame.noise.value());
      } else {
        const bool of_points = transport != nullptr && (aov == "normal" || aov == "part");
        GONIO_TRY(render::add_aov(of_points ? points.image : part.image, *frame.gbuffer, aov, to_light));
      }
    }
    part.type = image::PixelType::kFloat;
    part.attributes["goniochrome:aovLight"] = spelled(to_light);
    describe_view(options, frame.gbuffer->rays, scene.lights, part.attributes);
    part.attributes["goniochrome:operator"] = spelled(scene.reflection);
    Json names = Json::array(), materials = Json::array();
    for (const mesh::MeshPart& mesh_part : scene.mesh->parts) {
      names.push_back(mesh_part.name);
      materials.push_back(mesh_part.material);
    }
    Json trim = Json::array();
    for (const std::size_t i : dress.trim)
      if (dress.names[i] == kTrimName && !dress.worn[i]) trim.push_back(i + 1);
    part.attributes["goniochrome:trim"] = json_text(trim);
    if (transport != nullptr && scene.ground) names.push_back("floor"), materials.push_back("");
    part.attributes["goniochrome:parts"] = json_text(names);
    part.attributes["goniochrome:materials"] = json_text(materials);
  }
  std::vector<image::ImagePart> parts;
  if (transport != nullptr) part.attributes[render::kTransportAttribute] = transport->header;
  parts.push_back(std::move(part));
  if (transport != nullptr) {
    parts.push_back(std::move(points));
    parts.insert(parts.end(), transport->parts.begin(), transport->parts.end());
  }
  return parts;
}

Result<std::string> exr_frame(std::vector<image::ImagePart> picture) {
  picture.front().attributes.erase("goniochrome:plan");
  return image::exr_content("standard output", picture, image::ExrStorage::kPlain);
}

Result<void> FrameOutput::write(const std::string& frame, const PictureSize& size) {
  GONIO_ASSIGN(OutputFile out, OutputFile::create("-"));
  if (std::exchange(head_, false)) GONIO_TRY(out.write(image::frames_head(format_, size.width, size.height)));
  GONIO_TRY(out.write(frame));
  return out.flush();
}

}  // namespace goniochrome::tool
