// Everything that a picture is made from, read and put together.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "envmap/block_tree.h"
#include "envmap/environment.h"
#include "envmap/prefiltered.h"
#include "mesh/mesh.h"
#include "paints.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "render/spectra.h"
#include "render/surface_layer.h"
#include "request.h"
#include "transport_view.h"

namespace goniochrome::tool {

// The image that the environment was made from.
struct Source {
  std::optional<envmap::Environment> environment;
  std::string name;
  const envmap::Environment* image() const { return environment ? &*environment : nullptr; }
};

// The scene points into the rest, so that a stage stays where it is.
struct Stage {
  mesh::Mesh mesh;                                 // of its parts alone where there are buffers of it
  std::shared_ptr<const render::Gbuffer> gbuffer;  // of --gbuffer, or none
  std::optional<KeptTransport> transport;          // of --gbuffer, or none
  std::vector<DressedMesh> dresses;                // one, or those of --split
  std::optional<paint::Paint> floor_paint;         // of a floor that wears one
  envmap::PrefilteredEnvironment env;
  render::Scene scene;
  std::optional<render::MipCube> mip;
  std::unique_ptr<render::SurfaceLayer> layer;
  Source source;                                // where the picture is checked, or sums it
  std::optional<envmap::BlockTree> texels;      // of the source
  std::optional<envmap::Environment> sky;       // that rays meet: the environment at the resolution of its mirror part
  std::optional<render::SceneSpectra> spectra;  // of all paints and lamps, where the picture is drawn in bands
  std::optional<render::RaySetup> rays;         // none with engines that trace by themselves
};

// Reads what the options name, tells the session about the mesh, and dresses it in the first of the paints. A floor
// above the lowest point of the mesh takes the engine path. Error: what cannot be read or does not go together.
Result<void> set_stage(const Options& options, Request& request, Stage& stage, cli::Session& session);

// Puts the paints, textures and color maps of `dress` on the mesh of the scene.
void wear(const DressedMesh& dress, const Options& options, Stage& stage);

// The environment of --env. An image is filtered by the lobes of the basis, or of the paints where these have others,
// unless an earlier run kept it; the session says so. The stage is dressed. Error: what cannot be read.
Result<envmap::PrefilteredEnvironment> environment_of(const Options& options, const Request& request,
                                                      const Stage& stage, cli::Session& session);

// The image that the environment of the scene was made from: beside the environment, if it holds the same light; else
// its mirror part.
Result<Source> source_of(const Options& options, const render::Scene& scene, cli::Session& session);

}  // namespace goniochrome::tool
